// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/haptics/contact_model.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace viscera {
namespace {

using Kind = TickContact::Kind;

constexpr double kTick_s = 0.02;
constexpr double kStiff_n_per_m = 300;  ///< stiffness of a wall at z = 0 that the tip presses from above

/// Returns the contact of a tick for a tip that moves between two heights above the wall.
TickContact onWall(double from_m, double to_m, Kind kind = Kind::kPushes) {
  TickContact out;
  out.from_m = {0, 0, from_m};
  out.to_m = {0, 0, to_m};
  const double push = -kStiff_n_per_m * 0.5 * (from_m + to_m);
  out.kind = push > 0 || kind == Kind::kHolds ? kind : Kind::kFree;
  if (out.kind != Kind::kFree) out.reaction.force_n = {0, 0, push};
  return out;
}

ContactModel pressed(double from_m, double to_m, int ticks, double& now_s) {
  ContactModel model{TissueConstants{}};
  for (int i = 0; i < ticks; ++i) {
    const double a = from_m + (to_m - from_m) * i / ticks, b = from_m + (to_m - from_m) * (i + 1) / ticks;
    model.put(onWall(a, b), kTick_s, now_s += kTick_s);
  }
  now_s += kTick_s;
  return model;
}

TEST(ContactModel, GivesNothingInFreeMotion) {
  ContactModel model{TissueConstants{}};
  model.put(onWall(0.01, 0.005), kTick_s, 0);
  for (double z : {0.01, 0.0, -0.1}) EXPECT_EQ(model.at({0, 0, z}, kTick_s).force_n, Vector3d(0, 0, 0));
}

TEST(ContactModel, GivesTheTicksForceAtTheTicksPosition) {
  double now_s = 0;
  const ContactModel model = pressed(0, -0.004, 8, now_s);
  EXPECT_NEAR(model.at(model.anchor_m(), now_s).force_n.z(), -kStiff_n_per_m * model.anchor_m().z(), 1e-12);
}

TEST(ContactModel, LearnsAStiffnessFromTicks) {
  double now_s = 0;
  const ContactModel model = pressed(0, -0.004, 8, now_s);
  EXPECT_NEAR(model.stiffness_n_per_m()(2, 2), kStiff_n_per_m, 0.02 * kStiff_n_per_m);
}

TEST(ContactModel, HasNoJumpWhenATickComes) {
  double now_s = 0;
  ContactModel model = pressed(0, -0.004, 8, now_s);
  const Vector3d tip(0.0003, 0, -0.0041);
  TickContact other = onWall(-0.004, -0.0035);
  other.reaction.force_n.x() = 0.2;
  const Vector3d before = model.at(tip, now_s).force_n;
  model.put(other, kTick_s, now_s);
  EXPECT_LT((model.at(tip, now_s).force_n - before).norm(), 1e-12);
  // nor within the tick: no step of a millisecond exceeds its share
  const Vector3d after = model.at(tip, now_s + kTick_s).force_n;
  Vector3d last = before;
  for (int ms = 1; ms <= 20; ++ms) {
    const Vector3d now = model.at(tip, now_s + 1e-3 * ms).force_n;
    EXPECT_LT((now - last).norm(), 2 * (after - before).norm() / 20);
    last = now;
  }
}

TEST(ContactModel, NeverPullsAProbe) {
  double now_s = 0;
  const ContactModel model = pressed(0, -0.004, 8, now_s);
  for (double z = -0.01; z < 0.01; z += 1e-4) EXPECT_GE(model.at({0, 0, z}, now_s).force_n.z(), 0) << z;
  EXPECT_EQ(model.at({0, 0, 0.005}, now_s).force_n, Vector3d(0, 0, 0));
}

TEST(ContactModel, PullsAGrip) {
  ContactModel model{TissueConstants{}};
  model.put(onWall(-1e-3, -1e-3, Kind::kHolds), kTick_s, 0);
  EXPECT_GT(model.at({0, 0, -0.003}, kTick_s).force_n.z(), 0);
  EXPECT_LT(model.at({0, 0, 0.003}, kTick_s).force_n.z(), 0);
}

TEST(ContactModel, StaysPositiveAndBoundedWhateverTicksSay) {
  ContactModel model{TissueConstants{}};
  double now_s = 0;
  for (int i = 0; i < 500; ++i) {
    TickContact contact;
    contact.kind = i % 7 == 3 ? Kind::kHolds : Kind::kPushes;
    contact.from_m = contact.to_m = 1e-3 * Vector3d::Random();
    contact.reaction.force_n = 2 * Vector3d::Random();
    model.put(contact, kTick_s, now_s += kTick_s);
    const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(model.stiffness_n_per_m());
    EXPECT_GT(solver.eigenvalues().minCoeff(), -1e-9);
    EXPECT_LT(solver.eigenvalues().maxCoeff(), 1e5);
    EXPECT_LT((model.stiffness_n_per_m() - model.stiffness_n_per_m().transpose()).norm(), 1e-9);
  }
}

/// After a reset, a recovery or a change of mode, the tissue is no longer where it was.
TEST(ContactModel, RemembersNoSurfaceOfBefore) {
  double now_s = 0;
  ContactModel model = pressed(0, -0.004, 8, now_s);
  TickContact free = onWall(0.001, 0.001);
  free.anew = true;
  model.put(free, kTick_s, now_s += kTick_s);
  now_s += kTick_s;
  for (double z : {0.001, -0.001, -0.004}) EXPECT_EQ(model.at({0, 0, z}, now_s).force_n, Vector3d(0, 0, 0)) << z;
}

TEST(ContactModel, RemembersTheSurfaceThatATipHasJustLeft) {
  double now_s = 0;
  ContactModel model = pressed(0, -0.004, 8, now_s);
  model.put(onWall(0.001, 0.001), kTick_s, now_s += kTick_s);
  now_s += kTick_s;
  EXPECT_EQ(model.at({0, 0, 0.001}, now_s).force_n, Vector3d(0, 0, 0));
  EXPECT_NEAR(model.at({0, 0, -0.002}, now_s).force_n.z(), 0.002 * kStiff_n_per_m, 0.05 * 0.002 * kStiff_n_per_m);
}

TEST(ContactModel, GoesToNothingWhenItIsForgotten) {
  double now_s = 0;
  ContactModel model = pressed(0, -0.004, 8, now_s);
  model.clear(kTick_s, now_s);
  EXPECT_GT(model.at({0, 0, -0.004}, now_s).force_n.z(), 1);
  EXPECT_EQ(model.at({0, 0, -0.004}, now_s + kTick_s).force_n, Vector3d(0, 0, 0));
}

/// A blade is pressed into tissue, which yields at a force, and is drawn back.
TEST(ContactModel, ABladesForceIsLevelWhereTheTissuePartsAndFallsWhenItGoesBack) {
  constexpr double kLimit_n = 1;
  ContactModel model{TissueConstants{}};
  double now_s = 0, reached_m = 0;
  for (int i = 0; i < 20; ++i) {  // 0.5 mm per tick: stuck for seven ticks
    const double from_m = -5e-4 * i, to_m = -5e-4 * (i + 1);
    TickContact contact = onWall(from_m, to_m);
    contact.limit_n = kLimit_n;
    contact.reaction.force_n.z() = std::min(contact.reaction.force_n.z(), kLimit_n);
    model.put(contact, kTick_s, now_s += kTick_s);
    reached_m = 0.5 * (from_m + to_m);
  }
  now_s += kTick_s;
  const double ahead_n = model.at({0, 0, reached_m - 1e-3}, now_s).force_n.z();
  EXPECT_NEAR(ahead_n, kLimit_n, 1e-9);
  const double behind_n = model.at({0, 0, reached_m + 1e-3}, now_s).force_n.z();
  EXPECT_NEAR(behind_n, kLimit_n - 1e-3 * kStiff_n_per_m, 0.1 * kLimit_n);
  EXPECT_EQ(model.at({0, 0, reached_m + 0.01}, now_s).force_n.z(), 0);
  // In and out again between two ticks: no energy is gained.
  double work_j = 0, before_m = reached_m;
  for (int i = 1; i <= 400; ++i) {
    const double z_m = reached_m - 2e-3 * std::sin(2 * 3.14159265358979 * i / 400);
    work_j += model.at({0, 0, 0.5 * (z_m + before_m)}, now_s).force_n.z() * (z_m - before_m);
    before_m = z_m;
  }
  EXPECT_LT(work_j, 1e-6);
}

/// Returns the contact of a needle that points down and is held laterally by the tissue around it.
TickContact onNeedle(const Vector3d& at_m, const Vector3d& force_n) {
  TickContact out;
  out.kind = Kind::kPierces;
  out.from_m = out.to_m = at_m;
  out.along = -Vector3d::UnitZ();
  out.limit_n = 0.3;
  out.back_n = 0.1;
  out.stiffness_n_per_m = 1000;
  out.reaction.force_n = force_n;
  return out;
}

TEST(ContactModel, ANeedleIsHeldAcrossFromBothSides) {
  ContactModel model{TissueConstants{}};
  model.put(onNeedle({0, 0, 0}, {0.05, 0, 0.2}), kTick_s, 0);
  for (const double aside_m : {-1e-3, 1e-3})  // also if that reverses the force across, and exceeds the pushing force
    EXPECT_NEAR(model.at({aside_m, 0, 0}, kTick_s).force_n.x(), 0.05 - 1000 * aside_m, 1e-9) << aside_m;
  EXPECT_NEAR(model.at({0, 1e-3, 0}, kTick_s).force_n.y(), -1, 1e-9);
}

TEST(ContactModel, ANeedlesForceAlongEndsWhereItGoesOnAndWhereItComesBack) {
  ContactModel model{TissueConstants{}};
  model.put(onNeedle({0, 0, 0}, {0.05, 0, 0.2}), kTick_s, 0);
  EXPECT_NEAR(model.at({0, 0, -0.01}, kTick_s).force_n.z(), 0.3, 1e-9);
  EXPECT_NEAR(model.at({0, 0, 0.01}, kTick_s).force_n.z(), -0.1, 1e-9);
  EXPECT_NEAR(model.at({0, 0, 0.01}, kTick_s).force_n.x(), 0.05, 1e-9);  // the component across does not change
  EXPECT_LT(model.at({0, 0, 1e-4}, kTick_s).force_n.z(), 0.2);
}

/// Ticks in which the needle moves on at a constant force carry no information about the stiffness before.
TEST(ContactModel, ANeedleThatGoesOnLearnsNothingAlong) {
  ContactModel model{TissueConstants{}};
  double now_s = 0;
  for (int i = 0; i < 20; ++i)
    model.put(onNeedle({1e-4 * (i % 3), 0, -3e-4 * i}, {-0.15 * (i % 3), 0, 0.3}), kTick_s, now_s += kTick_s);
  EXPECT_NEAR(model.stiffness_n_per_m()(2, 2), 400, 1);
  EXPECT_NEAR(model.stiffness_n_per_m()(0, 0), 1500, 150);
}

/// Returns the contact of a suture of 300 N/m along x that is slack up to x = 0.
TickContact onThread(double at_m, double tension_n) {
  TickContact out;
  out.kind = Kind::kPulls;
  out.from_m = out.to_m = {at_m, 0, 0};
  out.reaction.force_n = {-tension_n, 0, 0};
  return out;
}

TEST(ContactModel, ASutureIsAsStiffAsTicksMeasure) {
  ContactModel model{TissueConstants{}};
  double now_s = 0;
  for (int i = 0; i < 8; ++i) model.put(onThread(5e-4 * i, 0.15 * i), kTick_s, now_s += kTick_s);
  now_s += kTick_s;
  EXPECT_NEAR(model.stiffness_n_per_m()(0, 0), 300, 10);
  EXPECT_NEAR(model.at({3e-3, 0, 0}, now_s).force_n.x(), -0.9, 0.02);
  EXPECT_EQ(model.at({-1e-3, 0, 0}, now_s).force_n, Vector3d(0, 0, 0));  // pulls in one direction only
  EXPECT_NEAR(model.at({3.5e-3, 1e-3, 0}, now_s).force_n.y(), 0, 1e-9);  // along a single axis
  EXPECT_NEAR(model.at({0.1, 0, 0}, now_s).force_n.x(), -2.1, 1e-9);     // and limited
}

/// A moving slack suture has the force of the tick, and no stiffness of tissue.
TEST(ContactModel, ASlackSutureGivesNoMoreThanTheTick) {
  constexpr double kDrag_n = 2e-3;
  ContactModel model{TissueConstants{1e5, 1e5, 0.25, 0.008}};
  double now_s = 0;
  for (int i = 8; i > 0; --i) model.put(onThread(5e-4 * i, 0.15 * i), kTick_s, now_s += kTick_s);
  for (int i = 0; i < 3; ++i) {
    model.put(onThread(-5e-4 * i, -kDrag_n), kTick_s, now_s += kTick_s);
    const double last_s = now_s + kTick_s;
    for (double x = -0.01; x < 0.002; x += 1e-4)
      EXPECT_LE(model.at({x, 0, 0}, last_s).force_n.norm(), 2 * kDrag_n + 1e-12) << i << " " << x;
  }
}

}  // namespace
}  // namespace viscera
