// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// The contract of TissuePort, tested on both backends and on the reference.
#include "solver/processes/port.h"

#include <gtest/gtest.h>

#include <map>
#include <optional>

#include "math/vec4.h"
#include "solver/cpu/cpu_backend.h"
#include "solver/gpu/gpu_backend.h"
#include "solver/reference/reference_solver.h"
#include "solver/ticks/tick_plan.h"
#include "viscera/gpu/context.h"
#include "viscera/model/scene/scene.h"

namespace viscera {
namespace {

constexpr float kPushed_s = 1e-3F;
constexpr double kSamePush = 1e-6;  // of float32 sums, over their size

/// An implementation of the port, with means to set and to read all of its state.
class Target {
 public:
  Target(const std::string& name, const Model& model, const Scene& scene) : plan_(planTicks(model, scene)) {
    if (name == "reference") {
      reference_ = std::make_unique<ReferenceSolver>(model, Vector3d::Zero(), static_cast<double>(kPushed_s));
      return;
    }
    if (name == "gpu") {
      context_.emplace();
      backend_ = std::make_unique<GpuBackend>(model, scene, plan_, GpuSolverOptions{{}, layout::kGroupSize});
    } else {
      backend_ = std::make_unique<CpuBackend>(model, scene, plan_, CpuSolverOptions{});
    }
    backend_->beginTick();
    backend_->writeMotions(std::vector<layout::ToolMotion>(
        static_cast<size_t>(plan_.mostSubsteps()) * layout::kMaxStyluses, layout::ToolMotion{}));
    backend_->selectMotions(0);
  }
  TissuePort& port() {
    if (reference_) return *reference_;
    return *backend_;
  }
  HostState read() const { return reference_ ? reference_->state() : backend_->readState(); }
  void set(const std::map<uint32_t, Vector3f>& u_m) {
    HostState state = read();
    for (const auto& [slot, u] : u_m) {
      state.displacement_m[slot] = {u.x(), u.y(), u.z(), 0};
      if (reference_) reference_->u_m[slot] = u.cast<double>();
    }
    if (backend_) backend_->loadState(state);
  }
  /// Returns the momentum that a stylus has given so far.
  Vector3d given(uint32_t stylus) {
    if (reference_) return reference_->impulse_n_s[stylus];
    layout::TickStats stats;
    backend_->measure();
    backend_->sumReactions({Vector3f::Zero(), Vector3f::Zero()});
    backend_->requestStats();
    backend_->takeStats(stats, true);
    return xyz(stats.impulse[stylus]);
  }

 private:
  TickPlan plan_;
  std::optional<gpu::Context> context_;
  std::unique_ptr<SolverBackend> backend_;
  std::unique_ptr<ReferenceSolver> reference_;
};

/// Returns two adjacent blocks, the first of which is fixed at its low side. A stylus has clips, so the GPU keeps the
/// data that the port needs.
Scene blocks() {
  return parseScene(
      "bodies:\n"
      "  - {name: left, source: box, box_size_m: [0.03, 0.02, 0.02], spacing_m: 0.005,\n"
      "     fixed: [{min_m: [-1, -1, -1], max_m: [1, 1, -0.009]}]}\n"
      "  - {name: right, source: box, box_size_m: [0.03, 0.02, 0.02], spacing_m: 0.005, position_m: [0.05, 0, 0]}\n"
      "styluses: [{name: a, button1: clip, button2: cut}, {name: b}]\n"
      "cameras: []\n",
      "blocks.yaml");
}

class Port : public ::testing::TestWithParam<std::string> {
 protected:
  Scene scene_ = blocks();
  Model model_ = buildModel(scene_);
  Target target_{GetParam(), model_, scene_};

  uint32_t slotOf(size_t body, size_t node) const {
    return model_.slotOffset(body) + model_.bodies[body].lattice.active_slots[node];
  }
  /// Returns the first fixed or free slot of the left block.
  uint32_t firstOf(bool fixed) const {
    const HostState state = target_.read();
    for (const uint32_t local : model_.bodies[0].lattice.active_slots) {
      if (isFixed(state.nodes[local]) == fixed) return local;
    }
    throw std::runtime_error("no such node");
  }
  size_t wholeSprings(size_t body) const {
    const HostState state = target_.read();
    size_t out = 0;
    for (const uint32_t local : model_.bodies[body].lattice.active_slots) {
      const layout::NodeBits bits = state.nodes[model_.slotOffset(body) + local];
      out += static_cast<size_t>(__builtin_popcount(bits.lo & layout::kAxialMask) +
                                 __builtin_popcount(bits.hi & layout::kDiagonalMask));
    }
    return out;
  }
};

TEST_P(Port, ReadsNodesOneByOneAndInRuns) {
  const uint32_t a = slotOf(0, 3), b = slotOf(1, 20);
  target_.set({{a, {1e-3F, -2e-3F, 3e-3F}}, {b, {4e-3F, 0, -1e-3F}}});
  std::vector<Vector3f> u(3), v(3);
  target_.port().readNodes({b, a, b}, u, v);
  EXPECT_EQ(u[0], Vector3f(4e-3F, 0, -1e-3F));
  EXPECT_EQ(u[1], Vector3f(1e-3F, -2e-3F, 3e-3F));
  EXPECT_EQ(u[2], u[0]);
  EXPECT_EQ(v[1], Vector3f(0, 0, 0));
  const uint32_t first = a - a % static_cast<uint32_t>(kRunSlots);
  RunPlanes u_runs, v_runs;
  for (RunPlanes* planes : {&u_runs, &v_runs}) {
    for (std::vector<float>& plane : *planes) plane.resize(kRunSlots);
  }
  target_.port().readRuns({first}, u_runs, v_runs);
  EXPECT_EQ(u_runs[2][a - first], 3e-3F);
  EXPECT_EQ(v_runs[0][a - first], 0);
}

TEST_P(Port, PushesFreeNodesAndCountsTheirMomentum) {
  const uint32_t free = firstOf(false), fixed = firstOf(true);
  const Vector3f dv(0.1F, 0, -0.2F);
  const Vector3d dv_m_per_s = dv.cast<double>();
  target_.port().pushNodes(1, kPushed_s, {free, fixed}, {dv, dv});
  const HostState after = target_.read();
  EXPECT_LT((xyz(after.velocity_m_per_s[free]) - dv_m_per_s).norm(), kSamePush);
  EXPECT_LT((xyz(after.displacement_m[free]) - static_cast<double>(kPushed_s) * dv_m_per_s).norm(),
            kSamePush * static_cast<double>(kPushed_s));
  EXPECT_EQ(xyz(after.displacement_m[fixed]), Vector3d(0, 0, 0));
  EXPECT_EQ(xyz(after.velocity_m_per_s[fixed]), Vector3d(0, 0, 0));
  const Vector3d given = target_.given(1);
  EXPECT_LT(given.normalized().cross(dv_m_per_s.normalized()).norm(), kSamePush);
  EXPECT_GT(given.norm(), 0);
  target_.port().pushNodes(layout::kMaxStyluses, kPushed_s, {free}, {dv});
  EXPECT_EQ(target_.given(0), Vector3d(0, 0, 0)) << "it is no stylus's";
}

/// A plane across the right body's middle cuts the springs that it crosses there, whatever the tissue's current shape.
TEST_P(Port, CutsTheSelectedBodyAsItIsAtRest) {
  const uint32_t moved = slotOf(1, 0);
  target_.set({{moved, {0.02F, 0.02F, 0.02F}}});
  layout::ToolMotion sweep{};
  const auto corner = [](float y, float z) { return layout::vec4{0.0523F, y, z, 0}; };
  sweep.from = corner(-0.02F, -0.02F);
  sweep.blade_from = corner(-0.02F, 0.02F);
  sweep.to = corner(0.02F, -0.02F);
  sweep.blade_to = corner(0.02F, 0.02F);
  const size_t left = wholeSprings(0), right = wholeSprings(1);
  target_.port().selectBody(0);
  target_.port().cutAtRest(sweep, false);
  EXPECT_EQ(wholeSprings(0), left);
  EXPECT_EQ(wholeSprings(1), right) << "it is not selected";
  target_.port().selectBody(1);
  target_.port().cutAtRest(sweep, false);
  EXPECT_EQ(wholeSprings(0), left);
  // Between two layers of 5 x 5 nodes: 25 axial springs and 2 x 2 x 4 x 5 diagonal ones, each with two ends.
  EXPECT_EQ(right - wholeSprings(1), 2U * (25 + 80));
  EXPECT_EQ(target_.read().displacement_m[moved].x, 0.02F) << "the tissue stays where it is";
}

INSTANTIATE_TEST_SUITE_P(All, Port, ::testing::Values("cpu", "gpu", "reference"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace viscera
