// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "session/thread_looks.h"

#include "model/scene/tool_kinds.h"
#include "solver/processes/suture/needle_shape.h"
#include "solver/processes/suture/thread_shape.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

namespace {

constexpr std::array<uint8_t, 4> kSteel = {190, 195, 202, 255}, kTitanium = {150, 200, 90, 255};
constexpr double kClipWire_m = 0.0005;
constexpr size_t kClipPlaces = 4;  // of Clips::places_m()

/// Dyed as such threads are.
std::array<uint8_t, 4> colorOf(ThreadMaterial material) {
  switch (material) {
    case ThreadMaterial::kSilk:
      return {60, 60, 70, 255};
    case ThreadMaterial::kNylon:
      return {40, 170, 110, 255};
    default:
      return {70, 110, 235, 255};
  }
}

}  // namespace

std::vector<ThreadLook> looksOf(const Scene& scene) {
  const std::vector<ThreadConfig>& threads = scene.threads;
  std::vector<ThreadLook> out;
  for (const ThreadConfig& thread : threads)
    out.push_back({materialOf(thread).radius_m, colorOf(thread.material), placesOf(thread).size(), out.size()});
  for (size_t t = 0; t < threads.size(); ++t) {
    const NeedleConfig& needle = threads[t].needle;
    if (needle.arc != NeedleArc::kNone)
      out.push_back({needle.wire_radius_m, kSteel, NeedleShape::kShown, t, ThreadPart::kNeedle});
  }
  if (mayClip(scene.styluses)) out.push_back({kClipWire_m, kTitanium, kClipPlaces, 0, ThreadPart::kClip, kMostClips});
  return out;
}

}  // namespace viscera
