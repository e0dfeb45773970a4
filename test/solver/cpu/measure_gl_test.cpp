// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Both backends measure the same.
#include <cstring>

#include "support/backends.h"
#include "support/implicit.h"

using namespace viscera;
using namespace viscera::test;

namespace {

// Float32 sums of some hundred terms, relative to the sum.
constexpr double kSum = 1e-5;
// A number from one node or spring, after a substep of each backend.
constexpr double kSingle = 5e-6;
// For cells of a law, each at most twice as far from float64 (law_gl_test.cpp).
constexpr double kLawSum = 4e-5, kLawSingle = 2e-5;

float number(uint32_t bits) {
  float value;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

class Measured : public GpuTest, public ::testing::WithParamInterface<std::string> {
 protected:
  /// Returns the same as randomState, with fixed nodes at rest.
  static HostState movedAtRandom(const Model& model, double size_m) {
    HostState state = randomState(model, size_m, 0.5, 3);
    for (uint32_t slot : model.bodies[0].lattice.active_slots) {
      if (isFixed(state.nodes[slot])) state.velocity_m_per_s[slot] = {};
    }
    return state;
  }
  /// Returns a backend's measurements after one substep from a state.
  layout::TickStats statsOf(const std::string& backend, const Model& model, const HostState& start,
                            const ToolMotions& motions = {}) {
    const PullAndProbe tools;
    const auto solver = makeBackend(backend, model, sceneFor(model, 1, tools.styluses));
    solver->writeState(start);
    solver->step(motions);
    layout::TickStats stats{};
    EXPECT_TRUE(solver->pollStats(stats, true));
    return stats;
  }
  void expectSame(const Model& model, const HostState& start, const ToolMotions& motions = {}) {
    const layout::TickStats gpu = statsOf("gpu", model, start, motions);
    const layout::TickStats cpu = statsOf(GetParam(), model, start, motions);
    const bool of_law = model.bodies[0].material.law == Law::kNeoHookean;
    const double sum = of_law ? kLawSum : kSum, single = of_law ? kLawSingle : kSingle;
    EXPECT_GT(gpu.elastic_j, 0);
    EXPECT_NEAR(cpu.kinetic_j, gpu.kinetic_j, sum * gpu.kinetic_j);
    EXPECT_NEAR(cpu.elastic_j, gpu.elastic_j, sum * gpu.elastic_j);
    const auto expectNear = [single](uint32_t bits, uint32_t truth_bits) {
      EXPECT_NEAR(number(bits), number(truth_bits), single * static_cast<double>(number(truth_bits)));
    };
    expectNear(cpu.max_stretch_bits, gpu.max_stretch_bits);
    expectNear(cpu.max_speed_bits, gpu.max_speed_bits);
    expectNear(cpu.max_rate_bits, gpu.max_rate_bits);
    EXPECT_EQ(cpu.collapsed, gpu.collapsed);
    EXPECT_EQ(cpu.inverted, gpu.inverted);
    EXPECT_EQ(cpu.springs_cut, gpu.springs_cut);
    for (size_t s = 0; s < 2; ++s) {
      EXPECT_EQ(cpu.grabbed[s], gpu.grabbed[s]);
      EXPECT_EQ(cpu.touched[s], gpu.touched[s]);
      const Vector3d truth = xyz(gpu.impulse[s]), moment = xyz(gpu.angular[s]);
      EXPECT_LE((xyz(cpu.impulse[s]) - truth).norm(), 1e-4 * truth.norm());  // absolute positions of tools
      EXPECT_LE((xyz(cpu.angular[s]) - moment).norm(), 1e-4 * std::max(moment.norm(), 0.01 * truth.norm()));
    }
  }
};

INSTANTIATE_TEST_SUITE_P(Targets, Measured, ::testing::ValuesIn([] {
                           std::vector<std::string> names = backendNames();
                           names.erase(names.begin());
                           return names;
                         }()),
                         backendSuffix);

Model boxOf(Law law) {
  Body body = boxBody({5, 6, 4}, 0.01);
  if (law == Law::kNeoHookean) body = ofLaw(body, 0.4);
  for (uint32_t slot : body.lattice.active_slots) {
    if (body.lattice.nodeAt(slot).z() == 0) body.lattice.nodes[slot].lo |= layout::kFixedBit;
  }
  return modelOf({body});
}

}  // namespace

TEST_P(Measured, OrdinaryStatesLikeTheGpus) {
  for (const Law law : {Law::kSprings, Law::kNeoHookean}) {
    SCOPED_TRACE(static_cast<int>(law));
    const Model model = boxOf(law);
    expectSame(model, movedAtRandom(model, 1e-3));
  }
  const Model blob = modelOf({blobBody(300, 0.01, 2)});
  expectSame(blob, movedAtRandom(blob, 1e-3));
  const Model parts = modelOf({twoPartBody(), boxBody({3, 3, 3}, 0.02)});
  expectSame(parts, movedAtRandom(parts, 1e-3));
}

TEST_P(Measured, CollapsedSpringsAndInvertedCellsLikeTheGpus) {
  for (const Law law : {Law::kSprings, Law::kNeoHookean}) {
    SCOPED_TRACE(static_cast<int>(law));
    const Model model = boxOf(law);
    const HostState wild = movedAtRandom(model, 0.012);
    EXPECT_GT(statsOf(GetParam(), model, wild).collapsed, 0u);
    EXPECT_GT(statsOf(GetParam(), model, wild).inverted, 0u);
    expectSame(model, wild);
  }
}

TEST_P(Measured, WhatToolsDidLikeTheGpus) {
  const Model model = boxOf(Law::kNeoHookean);
  ToolMotions motions = PullAndProbe().motions(0, 0.04);
  motions[0].from.position_m.z() = motions[0].to.position_m.z() = 0.01;  // free nodes
  expectSame(model, movedAtRandom(model, 1e-3), motions);
  motions[0].mode = ToolMode::kCut;
  motions[0].hold_begins = false;
  motions[0].from.position_m = Vector3d(-0.01, 0.015, 0.025);
  motions[0].to.position_m = Vector3d(0.06, 0.015, 0.025);
  EXPECT_GT(statsOf(GetParam(), model, movedAtRandom(model, 1e-3), motions).springs_cut, 0u);
  expectSame(model, movedAtRandom(model, 1e-3), motions);
}

/// A NaN in a node spreads to its neighbours in the next substep: through its springs and shared cells.
TEST_P(Measured, NodesThatAreNoNumbersLikeTheGpus) {
  for (const Law law : {Law::kSprings, Law::kNeoHookean}) {
    const Model model = boxOf(law);
    HostState state = movedAtRandom(model, 1e-3);
    const uint32_t slot = static_cast<uint32_t>(model.bodies[0].lattice.slotAt({2, 2, 2}));
    state.displacement_m[slot].y = std::numeric_limits<float>::quiet_NaN();
    const layout::TickStats gpu = statsOf("gpu", model, state), cpu = statsOf(GetParam(), model, state);
    EXPECT_EQ(cpu.nonfinite, gpu.nonfinite);
    EXPECT_GT(cpu.nonfinite, 0u);
    EXPECT_NEAR(cpu.kinetic_j, gpu.kinetic_j, kSum * gpu.kinetic_j);
  }
}
