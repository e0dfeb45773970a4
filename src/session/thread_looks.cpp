// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "session/thread_looks.h"

#include "solver/thread/needle_shape.h"
#include "solver/thread/thread_shape.h"

namespace viscera {

namespace {

constexpr std::array<uint8_t, 4> kSteel = {190, 195, 202, 255};

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

std::vector<ThreadLook> looksOf(const std::vector<ThreadConfig>& threads) {
  std::vector<ThreadLook> out;
  for (const ThreadConfig& thread : threads)
    out.push_back({materialOf(thread).radius_m, colorOf(thread.material), placesOf(thread).size(), out.size()});
  for (size_t t = 0; t < threads.size(); ++t) {
    const NeedleConfig& needle = threads[t].needle;
    if (needle.arc != NeedleArc::kNone) out.push_back({needle.wire_radius_m, kSteel, NeedleShape::kShown, t, true});
  }
  return out;
}

}  // namespace viscera
