// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// A half circle of radius 8 mm turned about its centre through blocks on a plate, in the reference (docs/physics.md
// 16).
#include "solver/processes/suture/needle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "math/archive.h"
#include "solver/reference/reference_solver.h"
#include "solver/ticks/tick_plan.h"
#include "viscera/model/model.h"
#include "viscera/model/scene/scene.h"

namespace viscera {
namespace {

constexpr double kArcPi = 3.14159265358979323846;
constexpr double kNeedleArc_m = 0.008, kBlockSkin_m = 0;  // the block's upper side
constexpr double kPunctureArea_m2 = 5e-6;                 // of the law

/// The reference as the tissue.
class NeedleTarget : public TissuePort {
 public:
  NeedleTarget(const Model& model, double dt_s) : solver(model, Vector3d::Zero(), dt_s) {}
  void readNodes(const std::vector<uint32_t>& slots, std::vector<Vector3f>& u_m,
                 std::vector<Vector3f>& v_m_per_s) const override {
    for (size_t i = 0; i < slots.size(); ++i) {
      u_m[i] = solver.u_m[slots[i]].cast<float>();
      v_m_per_s[i] = solver.v_m_per_s[slots[i]].cast<float>();
    }
  }
  void pushNodes(uint32_t stylus, float dt_s, const std::vector<uint32_t>& slots,
                 const std::vector<Vector3f>& dv_m_per_s) override {
    by = stylus;
    for (size_t i = 0; i < slots.size(); ++i) {
      solver.v_m_per_s[slots[i]] += dv_m_per_s[i].cast<double>();
      solver.u_m[slots[i]] += static_cast<double>(dt_s) * dv_m_per_s[i].cast<double>();
    }
  }
  void selectBody(size_t) override {}
  void cutAtRest(const layout::ToolMotion&, bool) override {}
  ReferenceSolver solver;
  uint32_t by = 99;
};

/// Material of a block, and where it is fixed.
struct NeedleBlock {
  double young_pa = 1e4;
  Vector3d size_m{0.027, 0.015, 0.009};
  bool plate = true, ends = false;  ///< below; at both ends in x
  double mass_damping_per_s = 4;
};

Scene needleBlockScene(const NeedleBlock& block) {
  Scene scene;
  BodyConfig body;
  body.source = TissueSource::kBox;
  body.box_size_m = block.size_m;
  body.position_m = {0, 0, kBlockSkin_m - 0.5 * block.size_m.z()};
  body.spacing_m = 0.003;
  body.material.young_modulus_pa = block.young_pa;
  body.material.mass_damping_per_s = block.mass_damping_per_s;
  // in the body's own frame
  const auto fix = [&](const Vector3d& min_m, const Vector3d& max_m) {
    FixedConfig fixed;
    fixed.min_m = min_m;
    fixed.max_m = max_m;
    body.fixed.push_back(fixed);
  };
  const double low = -0.5 * block.size_m.z(), end = 0.5 * block.size_m.x();
  if (block.plate) fix({-1, -1, -1}, {1, 1, low + 1e-4});
  if (block.ends) fix({-1, -1, -1}, {-end + 1e-4, 1, 1});
  if (block.ends) fix({end - 1e-4, -1, -1}, {1, 1, 1});
  scene.bodies.push_back(body);
  scene.environment.gravity_m_per_s2.setZero();
  return scene;
}

/// A stylus that turns a needle about a point.
class NeedleDrive {
 public:
  explicit NeedleDrive(const NeedleBlock& block, const NeedleConfig& config = halfCircle())
      : model_(buildModel(needleBlockScene(block))),
        dt_s_(0.8 * planTicks(model_, needleBlockScene(block)).dt_safe_s),
        target_(model_, dt_s_),
        tissue_(model_),
        needle_(config, model_, Vector3d::Zero()) {}
  static NeedleConfig halfCircle() {
    NeedleConfig out;
    out.arc = NeedleArc::kHalfCircle;
    out.radius_m = kNeedleArc_m;
    return out;
  }
  /// Returns a pose with the tip at an angle from x over z on a circle about a point, and forward for increasing
  /// angles.
  static Pose at(const Vector3d& middle_m, double angle_rad) {
    return {middle_m, Quaterniond(Eigen::AngleAxisd(-angle_rad, Vector3d::UnitY()))};
  }
  void appear(const Pose& pose) {
    while ((needle_.pose() * Vector3d::UnitX() - pose * Vector3d::UnitX()).norm() > 1e-12) {
      needle_.lead(pose, dt_s_);
      needle_.keepOut(nullptr, 0);
    }
  }
  /// Makes a substep.
  void to(const Pose& pose) {
    target_.solver.substep();
    needle_.lead(pose, dt_s_);
    needle_.keepOut(nullptr, 0);
    needle_.act(target_, tissue_, passed);
    given_n_s += dt_s_ * needle_.force_n();
  }
  /// Makes a substep in which it is free.
  void fall() {
    target_.solver.substep();
    needle_.fall({0, 0, -9.81}, dt_s_);
    needle_.keepOut(nullptr, 0);
    needle_.act(target_, tissue_, passed);
  }
  /// Turns by an angle, at a speed of the tip.
  template <class RenderRequest>
  void turn(const Vector3d& middle_m, double from_rad, double to_rad, double speed_m_per_s,
            const RenderRequest& request) {
    const double step = std::copysign(speed_m_per_s * dt_s_ / kNeedleArc_m, to_rad - from_rad);
    for (double angle = from_rad; (to_rad - angle) * step > 0; angle += step) {
      to(at(middle_m, angle));
      request(angle);
    }
  }
  Needle& needle() { return needle_; }
  ReferenceSolver& solver() { return target_.solver; }
  NeedleTarget& target() { return target_; }
  const Model& model() const { return model_; }
  double dt_s() const { return dt_s_; }
  std::vector<NeedlePassed> passed;
  Vector3d given_n_s = Vector3d::Zero();

 private:
  Model model_;
  double dt_s_;
  NeedleTarget target_;
  TissuePoints tissue_;
  Needle needle_;
};

const Vector3d kArcMiddle(0, 0, kBlockSkin_m + 0.002);
constexpr double kBiteStart = -kArcPi + 0.1, kBiteEnd = 0.35 * kArcPi;  // of the tip: outside before and after a bite
constexpr double kBiteLowest = -0.5 * kArcPi;

struct BiteCase {
  double young_pa, speed_m_per_s;
  bool whole;
};
class NeedleBite : public ::testing::TestWithParam<BiteCase> {};

TEST_P(NeedleBite, PuncturesAtItsForceAndIsSteadyInside) {
  const BiteCase bite = GetParam();
  NeedleBlock block;
  block.young_pa = bite.young_pa;
  NeedleDrive drive(block);
  const double puncture_n = kPunctureArea_m2 * bite.young_pa;
  double first_n = 0, second_n = 0, farthest_m = 0, pressed_m = 0, least_n = 1, most_n = 0;
  drive.appear(NeedleDrive::at(kArcMiddle, kBiteStart));
  const auto request = [&](double angle) {
    const Needle& needle = drive.needle();
    const double tip_n = needle.alongTip_n();
    farthest_m = std::max(farthest_m, needle.farthest_m());
    if (needle.crossings() == 0) {
      first_n = std::max(first_n, needle.force_n().norm());
      pressed_m = kBlockSkin_m - (needle.pose() * needle.shape().at(0)).z();
    }
    if (angle > kBiteLowest) second_n = std::max(second_n, tip_n);
    if (std::abs(angle - kBiteLowest) > 0.25) return;
    least_n = std::min(least_n, tip_n);
    most_n = std::max(most_n, tip_n);
  };
  drive.turn(kArcMiddle, kBiteStart, bite.whole ? kBiteEnd : kBiteLowest + 0.2, bite.speed_m_per_s, request);
  EXPECT_NEAR(first_n, puncture_n, 0.1 * puncture_n);
  EXPECT_GT(pressed_m, 1.2e-3);  // at any speed
  EXPECT_LT(pressed_m, 2.2e-3);
  EXPECT_NEAR(least_n, puncture_n / 3, 0.1 * puncture_n / 3);
  EXPECT_NEAR(most_n, puncture_n / 3, 0.1 * puncture_n / 3);
  EXPECT_LT(farthest_m, 0.7e-3);
  EXPECT_EQ(drive.target().by, layout::kMaxStyluses);
  RecordProperty("pressed_um", static_cast<int>(1e6 * pressed_m));
  RecordProperty("farthest_um", static_cast<int>(1e6 * farthest_m));
  if (!bite.whole) return;
  EXPECT_NEAR(second_n, puncture_n, 0.1 * puncture_n);
  drive.turn(kArcMiddle, kBiteEnd, kBiteEnd + kArcPi, bite.speed_m_per_s, request);
  EXPECT_LT(farthest_m, 0.7e-3);
  EXPECT_GE(drive.passed.size(), 6u);
  EXPECT_LE(drive.passed.size(), 10u);
  EXPECT_LE(drive.needle().crossings(), 5u);
  for (const NeedlePassed& passed : drive.passed) EXPECT_LT(passed.beyond_m, 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Tissue, NeedleBite,
                         ::testing::Values(BiteCase{1e4, 0.04, false}, BiteCase{1e4, 0.2, true},
                                           BiteCase{5e4, 0.04, false}, BiteCase{5e4, 0.2, true}));

/// Downwards through a slab, 6 mm thick, fixed at its ends.
TEST(Needle, FeelsBothSkinsOfASlab) {
  NeedleBlock block;
  block.size_m = {0.021, 0.015, 0.006};
  block.plate = false;
  block.ends = true;
  NeedleDrive drive(block);
  const Vector3d middle(kNeedleArc_m, 0, -0.003);
  const double start = -kArcPi - 0.55, puncture_n = kPunctureArea_m2 * block.young_pa;
  double first_n = 0, between_n = 1, second_n = 0;
  drive.appear(NeedleDrive::at(middle, start));
  drive.turn(middle, start, -kArcPi + 2.2, 0.1, [&](double) {
    const Needle& needle = drive.needle();
    const Vector3d turning_nm = needle.torque_nm() - middle.cross(needle.force_n());  // about the arc's centre
    const double along_n = -turning_nm.y() / kNeedleArc_m;
    if (needle.crossings() == 0) first_n = std::max(first_n, along_n);
    if (needle.crossings() == 3) between_n = std::min(between_n, along_n);
    if (needle.crossings() > 3) second_n = std::max(second_n, along_n);
  });
  EXPECT_NEAR(first_n, puncture_n, 0.1 * puncture_n);
  EXPECT_LT(between_n, 0.5 * puncture_n);
  EXPECT_GT(second_n, 0.9 * puncture_n);
  EXPECT_LT(second_n, 1.3 * puncture_n);  // plus the shaft's friction
  EXPECT_EQ(drive.needle().alongTip_n(), 0);
}

TEST(Needle, GivesATissueWhatItFeels) {
  NeedleBlock block;
  block.plate = false;
  block.mass_damping_per_s = 0;
  NeedleDrive drive(block);
  drive.appear(NeedleDrive::at(kArcMiddle, kBiteStart));
  double most_n_s = 0;
  drive.turn(kArcMiddle, kBiteStart, kBiteLowest, 1, [&](double) {
    const Vector3d has_n_s = drive.solver().momentum();
    most_n_s = std::max(most_n_s, has_n_s.norm());
    ASSERT_LT((has_n_s - drive.given_n_s).norm(), 1e-6 * std::max(most_n_s, 1e-6));
  });
  EXPECT_GT(most_n_s, 1e-5);
  EXPECT_GT(drive.needle().crossings(), 1u);
}

TEST(Needle, ComesOutByTheSamePath) {
  NeedleDrive drive(NeedleBlock{});
  drive.appear(NeedleDrive::at(kArcMiddle, kBiteStart));
  const auto nothing = [](double) {};
  drive.turn(kArcMiddle, kBiteStart, kBiteLowest, 0.2, nothing);
  ASSERT_GE(drive.needle().crossings(), 3u);
  drive.turn(kArcMiddle, kBiteLowest, kBiteStart, 0.2, nothing);
  EXPECT_FALSE(drive.needle().isInTissue());
  EXPECT_TRUE(drive.passed.empty());
  drive.turn(kArcMiddle, kBiteStart, kBiteLowest, 0.2, nothing);
  EXPECT_GE(drive.needle().crossings(), 3u);
}

TEST(Needle, GoesOnFromASavedStateToTheBit) {
  NeedleDrive one(NeedleBlock{}), two(NeedleBlock{});
  const auto nothing = [](double) {};
  one.appear(NeedleDrive::at(kArcMiddle, kBiteStart));
  two.appear(NeedleDrive::at(kArcMiddle, kBiteStart));
  one.turn(kArcMiddle, kBiteStart, kBiteLowest, 0.2, nothing);
  two.turn(kArcMiddle, kBiteStart, kBiteLowest, 0.2, nothing);
  EXPECT_EQ(one.solver().u_m, two.solver().u_m);
  Archive saved;
  saved.section("needle");
  one.needle().persist(saved);
  two.needle().reset();
  Archive read(saved.sections());
  read.section("needle");
  two.needle().persist(read);
  read.end();
  one.turn(kArcMiddle, kBiteLowest, 0, 0.2, nothing);
  two.turn(kArcMiddle, kBiteLowest, 0, 0.2, nothing);
  EXPECT_EQ(one.solver().u_m, two.solver().u_m);
  EXPECT_EQ(one.needle().crossings(), two.needle().crossings());
}

TEST(Needle, StaysInTissueWhereItIsLetGo) {
  NeedleDrive drive(NeedleBlock{});
  drive.appear(NeedleDrive::at(kArcMiddle, kBiteStart));
  drive.turn(kArcMiddle, kBiteStart, kBiteLowest, 0.2, [](double) {});
  const Vector3d tip = drive.needle().pose() * drive.needle().shape().at(0);
  for (double s = 0; s < 0.3; s += drive.dt_s()) drive.fall();
  EXPECT_LT((drive.needle().pose() * drive.needle().shape().at(0) - tip).norm(), 3e-3);
  EXPECT_GE(drive.needle().crossings(), 3u);
  EXPECT_LT(drive.needle().force_n().norm(), 0.01);
}

TEST(Needle, NeverComesThroughAnObstacle) {
  const NeedleShape shape(NeedleDrive::halfCircle());
  layout::ObstacleMotion plate{};
  plate.info.x = layout::kShapeBox;
  plate.half_size = {0.05F, 0.05F, 0.001F, 0};
  plate.from_orientation = plate.to_orientation = {0, 0, 0, 1};
  Pose at{{0, 0, 0.01}, Quaterniond::Identity()};
  for (int i = 0; i < 400; ++i) {
    const Pose asked{{0.02 * std::sin(0.1 * i), 0, 0.01 - 0.0002 * i}, rotationFromDegrees({0, 0.5 * i, 0.2 * i})};
    at = keptOut(shape, at, asked, &plate, 1);
    for (const Vector3d& position : shape.positions(at)) ASSERT_GT(position.z(), 0.001 + 0.8 * shape.wireRadius_m());
  }
  for (int i = 0; i < 400; ++i) at = keptOut(shape, at, {{0, 0, 0.02}, Quaterniond::Identity()}, &plate, 1);
  EXPECT_LT((at.position_m - Vector3d(0, 0, 0.02)).norm(), 1e-9);
}

}  // namespace
}  // namespace viscera
