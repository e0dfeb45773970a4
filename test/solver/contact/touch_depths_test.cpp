// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Touching nodes represent the surface, anywhere in the cells.
#include <gtest/gtest.h>

#include <array>
#include <random>

#include "layout/touch_depths.h"
#include "model/shape/organ/tissue.h"
#include "solver/contact/collision.h"
#include "viscera/model/model.h"
#include "viscera/model/scene/scene.h"

using namespace viscera;

namespace {

constexpr double kTouchDepthsSpacing_m = 0.01, kWidth_m = 0.08;

/// Returns a plate oblique to its cells.
BodyConfig touchDepthsPlate(double cells) {
  BodyConfig out;
  out.source = TissueSource::kBox;
  out.box_size_m = {kWidth_m, kWidth_m, cells * kTouchDepthsSpacing_m};
  out.spacing_m = kTouchDepthsSpacing_m;
  out.rotation_deg = {10, 20, 30};
  return out;
}

/// Returns the height above a plate's faces at which an approaching point stops, in spacings: least and largest of many
/// positions.
std::array<double, 2> stopsAbove(double cells) {
  Scene scene;
  scene.bodies = {touchDepthsPlate(cells)};
  const Model model = buildModel(scene);
  const std::vector<float> depths_m = touchDepths(model, scene.collision);
  const Quaterniond turned(bodyPose(scene.bodies[0]).orientation);
  const double distance_m = collisionDistance(model.bodies[0], scene.collision);
  std::mt19937 random(3);
  std::uniform_real_distribution<double> inner(-0.3 * kWidth_m, 0.3 * kWidth_m);
  std::array<double, 2> out = {1e9, -1e9};
  for (int position = 0; position < 400; ++position) {
    const double side = position % 2 ? 1 : -1;
    const Vector3d x(inner(random), inner(random), side * 0.5 * cells * kTouchDepthsSpacing_m);
    double stops_m = -1;
    for (const uint32_t slot : model.bodies[0].lattice.active_slots) {
      if (std::abs(depths_m[slot]) >= layout::kTouchesOnceCut) continue;
      const Vector3d apart = turned.conjugate() * restPosition(model.bodies[0], slot) - x;
      const double reach_m = distance_m + depths_m[slot], aside_m = std::hypot(apart.x(), apart.y());
      if (aside_m >= reach_m) continue;
      stops_m = std::max(stops_m, side * apart.z() + std::sqrt(reach_m * reach_m - aside_m * aside_m));
    }
    out = {std::min(out[0], stops_m / kTouchDepthsSpacing_m), std::max(out[1], stops_m / kTouchDepthsSpacing_m)};
  }
  return out;
}

}  // namespace

// Spheres that represent the surface reach it above their nodes, and leave dips between them.
TEST(TouchDepths, NothingComesThroughASurfaceNorStopsFarAboveIt) {
  constexpr double kLeast = 0.25;  // of the distance that nodes keep; a square of them on the surface leaves 0.71
  for (const double cells : {0.2, 0.4, 0.6, 0.8, 1.0, 1.3, 1.7, 2.5, 4.0}) {
    SCOPED_TRACE(cells);
    const auto [least, most] = stopsAbove(cells);
    EXPECT_GT(least, kLeast);
    EXPECT_LT(most, cells < 1 ? 1.45 : 1.05);  // nodes within a wall represent both of its faces, where there are some
  }
}
