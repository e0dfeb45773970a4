// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "export/node_loads.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/lattices.h"

namespace viscera {
namespace {

using namespace test;

constexpr double kLoadEdge_m = 0.01, kLonger = 0.1;
constexpr double kLoadRounding = 2e-6;  // relative, of float32 displacements over a cell

/// Returns a block of 4 x 3 x 3 cells that is stretched along x, as a state at this moment.
HostState stretched(const Model& model) {
  const Body& body = model.bodies[0];
  HostState state;
  state.nodes = body.lattice.nodes;
  state.displacement_m.resize(model.slots());
  state.velocity_m_per_s.resize(model.slots());
  for (const uint32_t slot : body.lattice.active_slots)
    state.displacement_m[slot].x = static_cast<float>(kLonger * restPosition(body, slot).x());
  return state;
}

TEST(NodeLoads, OfAStretchedBlockBalanceInsideAndPullAtItsEnds) {
  const Model model = modelOf({ofLaw(boxBody({4, 3, 3}, kLoadEdge_m), 0.3)});
  const Body& body = model.bodies[0];
  std::array<Vector3d, 8> u_m;
  for (size_t c = 0; c < 8; ++c) u_m[c] = Vector3d(c & 1 ? kLonger * kLoadEdge_m : 0, 0, 0);
  // Pull on a face: the stress along x, which only the face's own area at rest carries.
  const double pull_n =
      CellStresses(body).at(body.lattice.active_slots[0], u_m).cauchy_pa(0, 0) * kLoadEdge_m * kLoadEdge_m;
  ASSERT_GT(pull_n, 0);

  const std::vector<NodeLoad> loads = NodeLoads(model).of(stretched(model));
  ASSERT_EQ(loads.size(), body.lattice.active_slots.size());
  double low_m = 1, high_m = -1;
  for (const NodeLoad& load : loads) {
    low_m = std::min(low_m, static_cast<double>(load.position_m.x()));
    high_m = std::max(high_m, static_cast<double>(load.position_m.x()));
  }
  EXPECT_NEAR(high_m - low_m, 4 * kLoadEdge_m * (1 + kLonger), kLoadRounding);
  size_t inside = 0, ends = 0;
  for (size_t i = 0; i < loads.size(); ++i) {
    EXPECT_NEAR(loads[i].strain, kLonger, 10 * kLoadRounding);
    const Vector3d rest_m = restPosition(body, body.lattice.active_slots[i]);
    const double x_m = loads[i].position_m.x();
    const bool is_end = x_m < low_m + kLoadEdge_m / 2 || x_m > high_m - kLoadEdge_m / 2;
    const auto between = [&](int axis, double low, double high) {
      return rest_m[axis] > low + kLoadEdge_m / 2 && rest_m[axis] < high - kLoadEdge_m / 2;
    };
    const Vector3d first_m = restPosition(body, body.lattice.active_slots.front());
    const Vector3d last_m = restPosition(body, body.lattice.active_slots.back());
    if (!between(1, first_m.y(), last_m.y()) || !between(2, first_m.z(), last_m.z())) continue;
    EXPECT_NEAR(loads[i].force_n, is_end ? pull_n : 0, 100 * kLoadRounding * pull_n);
    ++(is_end ? ends : inside);
  }
  EXPECT_EQ(ends, 8U);
  EXPECT_EQ(inside, 12U);
}

TEST(NodeLoads, LeaveOutNodesThatNothingHolds) {
  const Model model = modelOf({ofLaw(boxBody({1, 1, 1}, kLoadEdge_m), 0.3)});
  HostState state = stretched(model);
  EXPECT_EQ(NodeLoads(model).of(state).size(), 8U);
  for (layout::NodeBits& node : state.nodes) node.lo &= ~layout::kCellBit;
  EXPECT_TRUE(NodeLoads(model).of(state).empty());
}

}  // namespace
}  // namespace viscera
