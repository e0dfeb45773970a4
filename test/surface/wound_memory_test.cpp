// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Wounds allocate no memory during a cut, once their buffers have grown.
#include <gtest/gtest.h>

#include "model/shape/mesh/box_surface.h"
#include "support/counted_memory.h"
#include "surface/skins/joined_skins.h"
#include "surface/wound_rig.h"
#include "surface/wounds/wounds.h"

namespace viscera::testing {
namespace {

constexpr double kSpacing_m = 0.005;
constexpr int kTicks = 40;
constexpr uint64_t kGrowing = 300;  // allocations of all buffers in a first cut, most of which double a few times

Model boxModel() {
  const TriangleMesh mesh = boxSurface(Vector3d::Zero(), Vector3d(0.08, 0.07, 0.06), {39, 35, 31});
  BoundSkin bound = bindTo(blockSolid({16, 14, 12}, kSpacing_m), mesh);
  Model model;
  Body& body = model.bodies.emplace_back();
  body.lattice = std::move(bound.lattice);
  body.skin = std::move(bound.skin);
  body.skin.can_be_cut = true;
  return model;
}

/// Makes a slanting cut that advances with each tick. @returns its number of allocations, while another is shown
/// @param box  with its springs whole
uint64_t cutThrough(Wounded& box, Wounds& wounds) {
  const Vector3d normal = Vector3d(1, 0.3, 0.2).normalized(), middle(0.041, 0.034, 0.03);
  std::shared_ptr<const VisibleWounds> shown = wounds.shown();
  uint64_t asked = 0;
  for (int tick = 1; tick <= kTicks; ++tick) {
    box.cut(middle, normal, [&](const Vector3d& at) { return at.z() > 0.06 * (1 - tick / double{kTicks}); });
    const CutSprings cuts{box.nodes, {}, box.axial_cut};
    const uint64_t before = allocations;
    wounds.update(cuts);
    asked += allocations - before;
    shown = wounds.shown();
  }
  EXPECT_TRUE(shown->bodies[0].wounded);
  EXPECT_GT(shown->bodies[0].walls.size(), 1000u);
  return asked;
}

/// The same cut twice, with a reset between: the second allocates nothing.
TEST(WoundMemory, ACutThatGoesOnAsksForNone) {
  const Model model = boxModel();
  Wounds wounds(model, joinSkins(model));
  Wounded first(model.bodies[0]), second(model.bodies[0]);
  EXPECT_LT(cutThrough(first, wounds), kGrowing);
  wounds.reset();
  EXPECT_EQ(cutThrough(second, wounds), 0u);
}

}  // namespace
}  // namespace viscera::testing
