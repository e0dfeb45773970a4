// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>

#include "solver/cpu/cpu_solver.h"
#include "solver/tissue/joined_lattice.h"
#include "support/lattices.h"
#include "viscera/model/scene/scene.h"

namespace viscera {
namespace {

constexpr double kSpacing_m = 0.005;
constexpr float kApart_m = 1, kSpeed_m_per_s = 20;  // 200 spacings: their 24th power is infinite in float32

/// A box of one brick. The half x > 1 was cut off and is far away and fast.
class FarApart : public ::testing::Test {
 protected:
  FarApart() : model_(test::modelOf({test::boxBody({3, 3, 3}, kSpacing_m)})) {
    model_.bodies[0].material.stiffness_damping_ratio = 0.2;
    scene_.environment.gravity_m_per_s2 = Vector3d::Zero();
    scene_.solver.stability_monitor = false;
    scene_.solver.sleep_distance_m = 10;
    scene_.solver.tick_hz = 500;
    state_.nodes = allNodes(model_);
    state_.displacement_m.resize(model_.slots());
    state_.velocity_m_per_s.resize(model_.slots());
    const Lattice& lattice = model_.bodies[0].lattice;
    for (uint32_t slot : lattice.active_slots) {
      cut(slot);
      if (!isCutOff(slot)) continue;
      state_.displacement_m[slot].x = kApart_m;
      state_.velocity_m_per_s[slot].x = kSpeed_m_per_s;
    }
  }

  bool isCutOff(uint32_t slot) const { return model_.bodies[0].lattice.nodeAt(slot).x() > 1; }

  void cut(uint32_t slot) {
    for (uint32_t spring = 0; spring < layout::kSpringsPerNode; ++spring) {
      const int64_t far = model_.bodies[0].lattice.neighborSlot(slot, spring);
      if (far < 0 || isCutOff(slot) == isCutOff(static_cast<uint32_t>(far))) continue;
      setSpringCount(state_.nodes[slot], spring, 0);
      state_.nodes[slot].lo = (state_.nodes[slot].lo | layout::kSeveredBit) & ~layout::kCellBit;
    }
  }

  Model model_;
  Scene scene_;
  HostState state_;
};

TEST_F(FarApart, PiecesThatShareABrickDoNotFeelEachOther) {
  CpuSolver solver(model_, scene_);
  solver.writeState(state_);
  solver.step({});
  const HostState after = solver.readState();
  const double passed_s = 1 / scene_.solver.tick_hz - solver.velocityLag_s();
  const double drag = std::exp(-MaterialConfig{}.mass_damping_per_s * passed_s);
  for (uint32_t slot : model_.bodies[0].lattice.active_slots) {
    const double expected = isCutOff(slot) ? static_cast<double>(kSpeed_m_per_s) * drag : 0;
    // m/s: 1 m rounded in float32 is a strain of 1e-5 in a spring of 5 mm; waves of it move at 1e-4 m/s.
    EXPECT_NEAR(static_cast<double>(after.velocity_m_per_s[slot].x), expected, 1e-3) << slot;
  }
}

}  // namespace
}  // namespace viscera
