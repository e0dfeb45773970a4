// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/suture/chain/chain_knots.h"

#include <gtest/gtest.h>

#include "solver/processes/suture/chain/chain.h"

namespace viscera {
namespace {

constexpr double kSubstep_s = 5e-4, kLink_m = 5e-4;
constexpr double kMomentum = 1e-12;  // of sum m |v|
constexpr double kForce = 0.06;      // of a friction: iterations end within 5 %

ChainMaterial limp() {
  ChainMaterial out;
  out.bending_nm2 = 4e-10;
  out.mass_damping_per_s = 20;
  return out;
}

/// A tail of 15 mm, a loop of 4 x sqrt(2) x 5 mm that returns to its start, a tail of 15 mm. In the middle of the loop
/// it rests on a peg.
struct Loop {
  explicit Loop(const ChainMaterial& material = limp()) : chain(material, positions()) {
    ChainKnot knot;
    knot.s1 = 30;
    knot.s2 = 30 + 4 * std::sqrt(2) * 5e-3 / kLink_m;
    peg = static_cast<uint32_t>((knot.s1 + knot.s2) / 2);
    last = static_cast<uint32_t>(chain.nodes() - 1);
    around.knots = {knot};
    for (const uint32_t node : {0U, peg}) {
      ChainHold hold;
      hold.node = node;
      hold.to_m = chain.positions_m()[node];
      around.holds.push_back(hold);
    }
  }
  static std::vector<Vector3d> positions() {
    const std::array<Vector3d, 7> corners = {Vector3d(-0.015, 0, 0), {0, 0, 0}, {0.005, 0, 0.005}, {0, 0, 0.01},
                                             {-0.005, 0, 0.005},     {0, 0, 0}, {0.015, 0, 0}};
    std::vector<Vector3d> out;
    double ahead_m = 0;  // of the next node, along a side
    for (size_t k = 0; k + 1 < corners.size(); ++k) {
      const Vector3d side = corners[k + 1] - corners[k];
      for (; ahead_m < side.norm(); ahead_m += kLink_m) out.push_back(corners[k] + ahead_m * side.normalized());
      ahead_m -= side.norm();
    }
    return out;  // links over corners are too short: the first substep corrects that
  }
  /// Pulls a tail with an increasing force.
  void pull(double force_n, int substeps) {
    for (int k = 0; k < substeps; ++k) {
      around.loads = {{last, Vector3d(force_n * std::min(1.0, k / 200.0), 0, 0)}};
      chain.step(kSubstep_s, around);
      worst_link = std::max(worst_link, chain.worstLink());
    }
  }
  double loop() const { return around.knots[0].s2 - around.knots[0].s1; }
  double off_m() const {
    const ChainKnot& knot = around.knots[0];
    return (ChainPoint(knot.s1, chain.nodes()).of(chain.positions_m()) -
            ChainPoint(knot.s2, chain.nodes()).of(chain.positions_m()))
        .norm();
  }
  Chain chain;
  ChainAround around;
  uint32_t peg, last;
  double worst_link = 0;
};

TEST(ChainKnots, ALoopIsDrawnTightUntilItIsTied) {
  Loop loop;
  loop.around.holds.pop_back();  // no peg
  loop.around.knots[0].friction_n = 0.002;
  const double before = loop.loop();
  loop.around.holds.push_back(loop.around.holds[0]);
  ChainHold& hold = loop.around.holds.back();
  hold.node = loop.last;
  hold.to_m = loop.chain.positions_m()[loop.last];
  for (int k = 0; k < 400; ++k) {
    hold.to_m.x() += 0.05 * kSubstep_s;
    loop.chain.step(kSubstep_s, loop.around);
    loop.worst_link = std::max(loop.worst_link, loop.chain.worstLink());
    if (k == 200) loop.around.knots[0].tied = true;
    if (k == 210) hold.most_n = 0.5;
  }
  EXPECT_NEAR(loop.loop(), before - 200 * 0.05 * kSubstep_s / kLink_m, 1.5);  // tied, it stays
  EXPECT_LT(loop.off_m(), 1e-6);
  EXPECT_LT(loop.worst_link, 1e-3);
}

TEST(ChainKnots, RubWhileTheyAreDrawn) {
  constexpr double kFriction_n = 0.03;
  Loop loop;
  loop.around.knots[0].friction_n = kFriction_n;
  ChainHold hold = loop.around.holds[0];
  hold.node = loop.last;
  hold.to_m = loop.chain.positions_m()[loop.last];
  loop.around.holds[1] = hold;
  double tail_n = 0, loop_n = 0;
  for (int k = 0; k < 800; ++k) {
    loop.around.holds[1].to_m.x() += 0.01 * kSubstep_s;
    loop.around.loads = {{loop.peg, Vector3d(0, 0, 0.06 * std::min(1.0, k / 200.0))}};
    loop.chain.step(kSubstep_s, loop.around);
    if (k < 400) continue;
    tail_n += loop.chain.tension_n(loop.last - 3) / 400;
    loop_n += loop.chain.tension_n(static_cast<size_t>(loop.around.knots[0].s2) - 6) / 400;
  }
  EXPECT_GT(loop_n, 0.01);
  EXPECT_NEAR(tail_n - loop_n, kFriction_n, 2 * kForce * kFriction_n);
  EXPECT_LT(loop.off_m(), 2e-5);
}

TEST(ChainKnots, TiedTheyHoldWhatTheyHoldAndSlipAboveThat) {
  constexpr double kHolds_n = 0.2;
  Loop loop;
  loop.around.knots[0].tied = true;
  loop.around.knots[0].holds_n = kHolds_n;
  loop.around.holds.pop_back();  // nothing is in the loop
  const double before = loop.loop();
  loop.pull(0.9 * kHolds_n, 400);
  EXPECT_NEAR(loop.loop(), before, 0.05);
  loop.around.loads.clear();
  loop.around.holds.push_back(loop.around.holds[0]);
  loop.around.holds[1].node = loop.last;
  loop.around.holds[1].to_m = loop.chain.positions_m()[loop.last];
  double tail_n = 0;
  for (int k = 0; k < 600; ++k) {
    loop.around.holds[1].to_m.x() += 0.01 * kSubstep_s;
    loop.chain.step(kSubstep_s, loop.around);
    if (k >= 400) tail_n += loop.chain.tension_n(loop.last - 3) / 200;
    loop.worst_link = std::max(loop.worst_link, loop.chain.worstLink());
  }
  EXPECT_NEAR(tail_n, kHolds_n, kForce * kHolds_n);
  EXPECT_NEAR(loop.loop(), before - 600 * 0.01 * kSubstep_s / kLink_m, 0.5);
  EXPECT_LT(loop.worst_link, 1e-3);
}

TEST(ChainKnots, KeepTheMomentumOfASuture) {
  ChainMaterial material = limp();
  material.mass_damping_per_s = 0;
  Loop loop(material);
  loop.around.holds.clear();
  loop.around.knots[0].friction_n = 1e-4;
  std::vector<Vector3d> speeds(loop.chain.nodes());
  for (size_t i = 0; i < speeds.size(); ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(speeds.size());
    speeds[i] = Vector3d(0.1, 0.1 * std::sin(9 * share), 0.1 * std::cos(5 * share));
  }
  loop.chain.setVelocities(speeds);
  double size = 0;
  const auto momentum = [&] {
    Vector3d out = Vector3d::Zero();
    for (size_t i = 0; i < loop.chain.nodes(); ++i) {
      const Vector3d p = loop.chain.mass_kg(i) * loop.chain.velocities_m_per_s()[i];
      out += p;
      size += p.norm();
    }
    return out;
  };
  loop.pull(0, 3);
  const Vector3d first = momentum();
  const double first_size = size;
  loop.pull(0, 500);
  EXPECT_LT((momentum() - first).norm(), kMomentum * first_size);
  EXPECT_LT(loop.off_m(), 2e-5);
}

TEST(ChainKnots, SeveralHoldAtOnceAndOneThatIsPulledOutDoesNothing) {
  Loop loop;
  ChainKnot second;
  second.s1 = 32;
  second.s2 = loop.around.knots[0].s2 - 2;  // the next throw on the first
  second.tied = true;
  loop.around.knots[0].tied = true;
  loop.around.knots.push_back(second);
  loop.pull(0.1, 600);
  for (const ChainKnot& knot : loop.around.knots) {
    EXPECT_LT((ChainPoint(knot.s1, loop.chain.nodes()).of(loop.chain.positions_m()) -
               ChainPoint(knot.s2, loop.chain.nodes()).of(loop.chain.positions_m()))
                  .norm(),
              1e-6);
  }
  EXPECT_LT(loop.worst_link, 1e-3);
  Loop slipping;  // pulled by its loop, its tail comes out
  slipping.around.loads.clear();
  for (int k = 0; k < 800 && !slipping.around.knots[0].out; ++k) {
    slipping.around.holds[1].to_m.z() += 0.05 * kSubstep_s;
    slipping.chain.step(kSubstep_s, slipping.around);
  }
  EXPECT_TRUE(slipping.around.knots[0].out);
  slipping.pull(0, 10);
  EXPECT_LT(slipping.chain.worstLink(), 1e-3);
}

}  // namespace
}  // namespace viscera
