// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Properties of a chain; its laws are tested in test/bench/suture_suite_test.cpp.
#include "solver/processes/suture/chain/chain.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>

#include "math/archive.h"

namespace viscera {
namespace {

constexpr double kChainSubstep_s = 5e-4, kChainLink_m = 5e-4;
constexpr double kSolve = 1e-9;  // of the largest unknown: its stiffnesses span eight decades

ChainMaterial chainSoft() {
  ChainMaterial out;
  out.bending_nm2 = 4e-8;
  out.mass_damping_per_s = 20;
  return out;
}

std::vector<Vector3d> along(const Vector3d& from_m, const Vector3d& direction, size_t nodes) {
  std::vector<Vector3d> out;
  for (size_t i = 0; i < nodes; ++i) out.push_back(from_m + static_cast<double>(i) * kChainLink_m * direction);
  return out;
}

ChainHold chainHeld(const Chain& chain, uint32_t node) {
  ChainHold out;
  out.node = node;
  out.to_m = chain.positions_m()[node];
  return out;
}

TEST(ChainMatrix, SolvesAsADenseOneDoes) {
  constexpr size_t kNodes = 12;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1, 1);
  const auto vector = [&] { return Vector3d(number(random), number(random), number(random)); };
  ChainMatrix matrix(kNodes);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(4 * kNodes, 4 * kNodes);
  const auto add = [&](size_t i, size_t j, const Matrix3d& what) {
    dense.block<3, 3>(4 * i, 4 * j) += what;
    if (i != j) dense.block<3, 3>(4 * j, 4 * i) += what.transpose();
  };
  for (size_t i = 0; i < kNodes; ++i) {
    const double stiff = 0.01 * static_cast<double>(i + 1);
    matrix.setNode(i, 1e-6 + 6 * stiff, -4 * stiff, stiff);
    add(i, i, (1e-6 + 6 * stiff) * Matrix3d::Identity());
    if (i + 1 < kNodes) add(i, i + 1, -4 * stiff * Matrix3d::Identity());
    if (i + 2 < kNodes) add(i, i + 2, stiff * Matrix3d::Identity());
  }
  for (size_t i = 0; i + 1 < kNodes; ++i) {
    const Vector3d n = vector().normalized();
    const double across = i % 3 == 0 ? -1 : 0.3;
    matrix.addLink(i, n, across);
    dense.block<3, 1>(4 * i, 4 * i + 3) -= n;
    dense.block<1, 3>(4 * i + 3, 4 * i) -= n.transpose();
    dense.block<3, 1>(4 * (i + 1), 4 * i + 3) += n;
    dense.block<1, 3>(4 * i + 3, 4 * (i + 1)) += n.transpose();
    if (across < 0) continue;
    const Matrix3d turned = across * (Matrix3d::Identity() - n * n.transpose());
    add(i, i, turned);
    add(i + 1, i + 1, turned);
    add(i, i + 1, -turned);
  }
  const Vector3d direction = vector();
  const Matrix3d chainHeld = 100 * Matrix3d::Identity() + direction * direction.transpose();
  matrix.addPoint(4, 0.3, 100, direction);
  add(4, 4, 0.49 * chainHeld);
  add(5, 5, 0.09 * chainHeld);
  add(4, 5, 0.21 * chainHeld);
  dense(4 * kNodes - 1, 4 * kNodes - 1) = -1;
  std::vector<ChainMatrix::Unknown> right(kNodes);
  Eigen::VectorXd known(4 * kNodes);
  for (size_t i = 0; i < kNodes; ++i) {
    right[i] = {vector(), i + 1 < kNodes ? number(random) : 0};
    known.segment<3>(4 * i) = right[i].position;
    known[4 * i + 3] = right[i].tension;
  }
  const Eigen::VectorXd exact = dense.fullPivLu().solve(known);
  matrix.factor();
  matrix.solve(right);
  for (size_t i = 0; i < kNodes; ++i) {
    EXPECT_LT((right[i].position - exact.segment<3>(4 * i)).norm(), kSolve * exact.lpNorm<Eigen::Infinity>());
    EXPECT_NEAR(right[i].tension, exact[4 * i + 3], kSolve * exact.lpNorm<Eigen::Infinity>());
  }
}

TEST(Chain, HangsWithItsWeightFromATool) {
  Chain chain(chainSoft(), along(Vector3d::Zero(), -Vector3d::UnitZ(), 100));
  ChainAround around;
  around.gravity_m_per_s2 = Vector3d(0, 0, -9.81);
  around.holds = {chainHeld(chain, 0)};
  for (int k = 0; k < 400; ++k) chain.step(kChainSubstep_s, around);
  double mass_kg = 0;
  for (size_t i = 0; i < chain.nodes(); ++i) mass_kg += chain.mass_kg(i);
  EXPECT_NEAR(around.holds[0].impulse_ns.z() / kChainSubstep_s, -9.81 * mass_kg, 1e-6 * 9.81 * mass_kg);
  EXPECT_NEAR(chain.tension_n(0), 9.81 * (mass_kg - chain.mass_kg(0)), 1e-6 * 9.81 * mass_kg);
}

TEST(Chain, SlipsInAToolThatIsNotStrongEnough) {
  Chain chain(chainSoft(), along(Vector3d::Zero(), Vector3d::UnitX(), 100));
  ChainAround around;
  around.holds = {chainHeld(chain, 0), chainHeld(chain, 99)};
  around.holds[1].most_n = 2;
  const Vector3d start = around.holds[1].to_m;
  for (int k = 0; k < 400; ++k) {
    around.holds[1].to_m.x() = start.x() + 0.1 * kChainSubstep_s * k;  // the suture is straight: it cannot follow
    chain.step(kChainSubstep_s, around);
  }
  EXPECT_NEAR(around.holds[1].impulse_ns.norm() / kChainSubstep_s, 2, 0.1);  // kSlack
  EXPECT_NEAR(chain.tension_n(50), 2, 0.1);
  EXPECT_LT(chain.positions_m().back().x(), start.x() + 1e-6);
  EXPECT_LT(chain.worstLink(), 1e-4);
}

TEST(Chain, LiesStillOnASlopeThatIsNotTooSteepAndSlidesDownAnother) {
  constexpr double kFriction = 0.5, kPull = 9.81;
  for (const double slope : {0.4, 0.7}) {  // tangents
    const Vector3d down = Vector3d(1, 0, -slope).normalized(), up(-down.z(), 0, down.x());
    Chain chain(ChainMaterial{}, along(1e-4 * up, down, 50));
    ChainAround around;
    around.gravity_m_per_s2 = Vector3d(0, 0, -kPull);
    for (uint32_t i = 0; i < chain.nodes(); ++i) {
      ChainTouch touch;
      touch.node = i;
      touch.normal = up;
      touch.friction = kFriction;
      around.touches.push_back(touch);
    }
    constexpr int kSteps = 400;
    for (int k = 0; k < kSteps; ++k) chain.step(kChainSubstep_s, around);
    const double time_s = kSteps * kChainSubstep_s, cosine = 1 / std::sqrt(1 + slope * slope);
    const double free = kPull * cosine * (slope - kFriction);
    const double speed = chain.velocities_m_per_s()[25].dot(down);
    EXPECT_NEAR(speed, std::max(free, 0.0) * time_s, 0.05 * kPull * time_s) << slope;
    if (free < 0) {
      EXPECT_LT(std::abs(speed), 1e-6);
    }
    EXPECT_NEAR(chain.positions_m()[25].dot(up), 1e-4, 1e-9);
  }
}

TEST(Chain, StaysWhereItWasAtAForceThatIsNoNumber) {
  Chain chain(chainSoft(), along(Vector3d::Zero(), Vector3d::UnitX(), 10));
  const std::vector<Vector3d> before = chain.positions_m();
  ChainAround around;
  around.loads = {{3, Vector3d(0, 0, std::numeric_limits<double>::quiet_NaN())}};
  chain.step(kChainSubstep_s, around);
  EXPECT_EQ(chain.positions_m(), before);
  around.loads.clear();
  chain.step(kChainSubstep_s, around);
  EXPECT_LT((chain.positions_m()[3] - before[3]).norm(), 1e-12);
}

TEST(Chain, GoesOnFromASavedStateAndResets) {
  const auto makeOne = [] { return Chain(chainSoft(), along(Vector3d::Zero(), Vector3d(1, 1, 0).normalized(), 80)); };
  const auto around = [](const Chain& chain) {
    ChainAround out;
    out.gravity_m_per_s2 = Vector3d(0, 0, -9.81);
    out.holds = {chainHeld(chain, 0)};
    return out;
  };
  Chain one = makeOne();
  const Chain first = one;
  ChainAround beside = around(one);
  for (int k = 0; k < 100; ++k) one.step(kChainSubstep_s, beside);
  Archive saved;
  saved.section("suture");
  one.persist(saved);
  Chain two = makeOne();
  Archive read(saved.sections());
  read.section("suture");
  two.persist(read);
  for (int k = 0; k < 50; ++k) {
    one.step(k < 25 ? kChainSubstep_s : kChainSubstep_s / 2, beside);
    two.step(k < 25 ? kChainSubstep_s : kChainSubstep_s / 2, beside);
  }
  EXPECT_EQ(one.positions_m(), two.positions_m());
  EXPECT_EQ(one.velocities_m_per_s(), two.velocities_m_per_s());
  one.reset();
  EXPECT_EQ(one.positions_m(), first.positions_m());
  EXPECT_EQ(one.velocities_m_per_s(), first.velocities_m_per_s());
}

TEST(Chain, PartsAtANodeWithItsMomentumAndComesBackWhole) {
  Chain chain(chainSoft(), along(Vector3d::Zero(), Vector3d::UnitX(), 60));
  ChainAround around;
  around.gravity_m_per_s2 = Vector3d(0, 0, -9.81);
  around.holds = {chainHeld(chain, 0), chainHeld(chain, 59)};
  around.slides.resize(3);
  for (size_t k = 0; k < 3; ++k) around.slides[k].s = 10.5 + 20 * static_cast<double>(k);
  for (ChainSlide& slide : around.slides) slide.to_m = Vector3d(slide.s * kChainLink_m, 0, 0);
  ChainKnot knot;
  knot.s1 = 12;
  knot.s2 = 45;
  for (int k = 0; k < 20; ++k) chain.step(kChainSubstep_s, around);
  around.knots = {knot};
  const auto momentum = [](const Chain& it) {
    Vector3d out = Vector3d::Zero();
    for (size_t i = 0; i < it.nodes(); ++i) out += it.mass_kg(i) * it.velocities_m_per_s()[i];
    return out;
  };
  const Vector3d before = momentum(chain);
  const Chain whole = chain;
  Chain behind = chain.part(28);
  ChainAround beyond = partAround(28, around);
  EXPECT_LT((momentum(chain) + momentum(behind) - before).norm(), 1e-15 * before.norm());
  EXPECT_EQ(chain.nodes(), 29U);
  EXPECT_EQ(behind.nodes(), 32U);
  EXPECT_EQ(behind.positions_m()[0], chain.positions_m()[28]);
  EXPECT_EQ(behind.tension_n(7), whole.tension_n(35));
  ASSERT_EQ(around.slides.size(), 1U);
  ASSERT_EQ(beyond.slides.size(), 2U);
  EXPECT_NEAR(beyond.slides[0].s, 2.5, 1e-6);
  ASSERT_EQ(beyond.holds.size(), 1U);
  EXPECT_EQ(beyond.holds[0].node, 31U);
  EXPECT_TRUE(around.knots.empty() && beyond.knots.empty());
  for (int k = 0; k < 40; ++k) {
    chain.step(kChainSubstep_s, around);
    behind.step(kChainSubstep_s, beyond);
  }
  EXPECT_LT(chain.positions_m().back().z(), -1e-6);  // hangs down beyond its channel
  Archive saved;
  saved.section("sutures");
  behind.persist(saved);
  Archive read(saved.sections());
  read.section("sutures");
  Chain again = whole;
  again.persist(read);
  EXPECT_EQ(again.positions_m(), behind.positions_m());
  behind.step(kChainSubstep_s, beyond);
  chain.reset();
  EXPECT_EQ(chain.nodes(), 60U);
  chain.step(kChainSubstep_s, around);
  EXPECT_LT(chain.worstLink(), 1e-3);
}

}  // namespace
}  // namespace viscera
