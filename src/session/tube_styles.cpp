// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "session/tube_styles.h"

#include "model/scene/tool_kinds.h"
#include "solver/processes/suture/needle_shape.h"
#include "solver/processes/suture/suture_shape.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

namespace {

constexpr std::array<uint8_t, 4> kSteel = {190, 195, 202, 255}, kTitanium = {150, 200, 90, 255},
                                 kConnective = {206, 168, 132, 255};  // sRGB, by eye: pale, a little yellow
constexpr double kClipWire_m = 0.0005;
constexpr double kStrand_m = 0.00018;  // radius of a strand at its ends, by eye
constexpr size_t kClipPositions = 4;   // number of Clips::positions_m()

/// Returns the usual dye of such sutures.
std::array<uint8_t, 4> colorOf(SutureMaterial material) {
  switch (material) {
    case SutureMaterial::kSilk:
      return {60, 60, 70, 255};
    case SutureMaterial::kNylon:
      return {40, 170, 110, 255};
    default:
      return {70, 110, 235, 255};
  }
}

}  // namespace

std::vector<TubeStyle> stylesOf(const Scene& scene) {
  const std::vector<SutureConfig>& sutures = scene.sutures;
  std::vector<TubeStyle> out;
  for (const SutureConfig& suture : sutures)
    out.push_back({materialOf(suture).radius_m, colorOf(suture.material), positionsOf(suture).size(), out.size()});
  for (size_t t = 0; t < sutures.size(); ++t) {
    const NeedleConfig& needle = sutures[t].needle;
    if (needle.arc != NeedleArc::kNone)
      out.push_back({needle.wire_radius_m, kSteel, NeedleShape::kShown, t, TubeKind::kNeedle});
  }
  if (!scene.attachments.empty())
    out.push_back({kStrand_m, kConnective, kStrandNodes, 0, TubeKind::kStrand, kMostStrands});
  if (mayClip(scene.styluses)) out.push_back({kClipWire_m, kTitanium, kClipPositions, 0, TubeKind::kClip, kMostClips});
  return out;
}

}  // namespace viscera
