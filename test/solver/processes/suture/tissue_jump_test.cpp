// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/suture/tissue_jump.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "solver/cpu/cpu_solver.h"
#include "solver/processes/suture/stitch.h"
#include "solver/processes/suture/thread_bodies.h"

namespace viscera {
namespace {

using namespace test;

/// A stitch that has come to rest in tissue whose middle is then put up to 4 mm beside its place, as if it was folded
/// there.
class Jumping {
 public:
  Jumping() : model_(modelOf({stitchBox()})), scene_(stitchScene()) {
    scene_.solver.threads = 1;
    scene_.threads[0].start = ThreadEnd::kFree;
    solver_ = std::make_unique<CpuSolver>(model_, scene_);
    for (int t = 0; t < kRestTicks; ++t) solver_->step(ToolMotions{});
    rest_ = folded_ = solver_->readState();
    const Body& body = model_.bodies[0];
    for (const uint32_t slot : body.lattice.active_slots)
      add(folded_.displacement_m[slot], wayAt(restPosition(body, slot)));
    threads().tissueMoved(rest_.displacement_m, folded_);
  }
  static void add(layout::vec4& to, const Vector3d& way_m) {
    to.x += static_cast<float>(way_m.x());
    to.y += static_cast<float>(way_m.y());
    to.z += static_cast<float>(way_m.z());
  }
  static constexpr int kRestTicks = 30;
  /// No way at both ends, which are fixed.
  static Vector3d wayAt(const Vector3d& rest_m) {
    constexpr double kLength_m = 0.033;
    const double along = std::sin(EIGEN_PI * rest_m.x() / kLength_m);
    return along * Vector3d(0.001, 0.0025, -0.003);
  }
  void unfold(bool carries) {
    if (carries) threads().tissueMoved(folded_.displacement_m, rest_);
    solver_->writeState(rest_);
  }
  ThreadBodies& threads() { return *findProcess<ThreadBodies>(*solver_); }
  const Chain& chain() { return threads().chain(0); }
  Vector3d atChannel(size_t k) {
    const double s = threads().slides(0)[k].s;
    const auto i = static_cast<size_t>(s);
    const double share = s - static_cast<double>(i);
    return (1 - share) * chain().places_m()[i] + share * chain().places_m()[i + 1];
  }
  double worstLink() {
    double out = 0;
    for (size_t i = 0; i + 1 < chain().nodes(); ++i) {
      const double length_m = (chain().places_m()[i + 1] - chain().places_m()[i]).norm();
      out = std::max(out, std::abs(length_m / chain().link_m() - 1));
    }
    return out;
  }
  /// @returns the fastest node of the thread in the ticks to come
  double fastest_m_per_s(int ticks) {
    double out = 0;
    for (int t = 0; t < ticks; ++t) {
      solver_->step(ToolMotions{});
      for (const Vector3d& v : chain().velocities_m_per_s()) out = std::max(out, v.norm());
    }
    return out;
  }

 private:
  Model model_;
  Scene scene_;
  std::unique_ptr<CpuSolver> solver_;
  HostState rest_, folded_;
};

TEST(TissueJump, ThreadGoesWithItsChannelsAndKeepsItsLength) {
  constexpr double kOn_m = 0.2 * kStitchSpacing_m;  // the way is linear in each cell
  constexpr double kLink = 1e-3, kStill_m_per_s = 1e-3;
  Jumping jumping;
  const std::vector<ThreadChannelConfig> channels = stitch().channels;
  for (size_t k = 0; k < channels.size(); ++k) {
    const Vector3d& rest_m = channels[k].position_m;
    EXPECT_LT((jumping.atChannel(k) - rest_m - Jumping::wayAt(rest_m)).norm(), kOn_m) << k;
  }
  EXPECT_LT(jumping.worstLink(), kLink);
  const auto first = static_cast<size_t>(jumping.threads().slides(0).front().s) + 1;
  const auto last = static_cast<size_t>(jumping.threads().slides(0).back().s);
  for (size_t i = first; i <= last; ++i) EXPECT_LT(jumping.chain().velocities_m_per_s()[i].norm(), kStill_m_per_s) << i;
}

TEST(TissueJump, ThreadThatGoesBackWithTheTissueIsNotFlung) {
  constexpr double kCalm_m_per_s = 0.3, kFlung_m_per_s = 0.6;
  Jumping with, without;
  with.unfold(true);
  without.unfold(false);
  const double calm = with.fastest_m_per_s(3), flung = without.fastest_m_per_s(3);
  EXPECT_LT(calm, kCalm_m_per_s);
  EXPECT_GT(flung, kFlung_m_per_s);
  EXPECT_EQ(with.threads().slides(0).size(), stitch().channels.size());
}

}  // namespace
}  // namespace viscera
