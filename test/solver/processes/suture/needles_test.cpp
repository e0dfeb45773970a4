// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Styluses that take a needle, drive it through tissue and release it, on the CPU backend.
#include "solver/processes/suture/needles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "math/archive.h"
#include "solver/cpu/cpu_solver.h"
#include "solver/processes/suture/suture_bodies.h"
#include "viscera/model/scene/scene.h"

namespace viscera {
namespace {

constexpr double kSewnPi = 3.14159265358979323846;
constexpr double kSewnArc_m = 0.008, kSewnAbove_m = 0.003;  // the needle's circle: radius; height of its centre
constexpr double kSewnTick_s = 1.0 / 60;

/// Returns a block on a plate, its surface at z = 0, and a needle with its tip above it; a suture upwards from the
/// tail.
Scene sewnBlock(int threads) {
  Scene scene;
  BodyConfig body;
  body.source = TissueSource::kBox;
  body.box_size_m = {0.03, 0.018, 0.012};
  body.position_m = {0, 0, -0.006};
  body.spacing_m = 0.003;
  body.material.young_modulus_pa = 1e4;
  FixedConfig plate;
  plate.min_m = {-1, -1, -1};
  plate.max_m = {1, 1, -0.0059};
  body.fixed.push_back(plate);
  scene.bodies.push_back(body);
  StylusConfig stylus;
  stylus.idle = ToolMode::kNone;
  stylus.button1 = ToolMode::kNeedle;
  scene.styluses.push_back(stylus);
  SutureConfig suture;
  suture.position_m = {kSewnArc_m, 0, kSewnAbove_m};
  suture.path = {{{kSewnArc_m, 0, kSewnAbove_m + 0.09}}};
  suture.needle.arc = NeedleArc::kHalfCircle;
  suture.needle.radius_m = kSewnArc_m;
  suture.needle.rotation_deg = {0, 180, 0};  // the tip at -x, pointing down
  scene.sutures.push_back(suture);
  scene.solver.backend = Backend::kCpu;
  scene.solver.threads = threads;
  return scene;
}

class Sewing {
 public:
  explicit Sewing(int threads = 1, const Scene& scene = sewnBlock(1)) : scene_(scene), model_(buildModel(scene)) {
    scene_.solver.threads = threads;
    solver_ = std::make_unique<CpuSolver>(model_, scene_);
  }
  /// Returns the pose of the stylus: its tip on the centre of the needle's circle, turned with it.
  static Pose toolAt(double turn_rad) {
    return {Vector3d(0, 0, kSewnAbove_m), Quaterniond(Eigen::AngleAxisd(-turn_rad, Vector3d::UnitY()))};
  }
  void toolIsAt(double turn_rad) { at_ = toolAt(turn_rad); }
  void tick(const Pose& to, ToolMode mode) {
    ToolMotions motions;
    motions[0].present = true;
    motions[0].mode = mode;
    motions[0].from = was_ ? at_ : to;
    motions[0].to = at_ = to;
    was_ = true;
    solver_->step(motions);
    while (solver_->pollStats(stats, true)) nonfinite += stats.nonfinite;
  }
  /// Cuts with the other stylus, before the first one comes.
  void cutFrom(const Vector3d& from_m, const Vector3d& to_m) {
    constexpr int kTicks = 12;
    for (int i = 0; i < kTicks; ++i) {
      ToolMotions motions;
      motions[1].present = true;
      motions[1].mode = ToolMode::kCut;
      motions[1].from.position_m = from_m + (to_m - from_m) * i / kTicks;
      motions[1].to.position_m = from_m + (to_m - from_m) * (i + 1) / kTicks;
      solver_->step(motions);
      while (solver_->pollStats(stats, true)) nonfinite += stats.nonfinite;
    }
  }
  /// Turns about the centre of its circle.
  template <class RenderRequest>
  void turn(double from_rad, double to_rad, double speed_m_per_s, const RenderRequest& request) {
    const double step = std::copysign(speed_m_per_s * kSewnTick_s / kSewnArc_m, to_rad - from_rad);
    for (double angle = from_rad; (to_rad - angle) * step > 0; angle += step) {
      tick(toolAt(angle), ToolMode::kNeedle);
      request(angle);
    }
  }
  void turn(double from_rad, double to_rad, double speed_m_per_s) {
    turn(from_rad, to_rad, speed_m_per_s, [](double) {});
  }
  const Needle& needle() const { return *findProcess<SutureBodies>(*solver_)->needle(0); }
  CpuSolver& solver() { return *solver_; }
  const Model& model() const { return model_; }
  double force_n() const {
    return Vector3d(stats.impulse[0].x, stats.impulse[0].y, stats.impulse[0].z).norm() / kSewnTick_s;
  }
  uint64_t hash() const {
    return hashWith(stateHash(model_, solver_->readState()), *findProcess<SutureBodies>(*solver_));
  }
  layout::TickStats stats{};
  uint64_t nonfinite = 0;

 private:
  Scene scene_;
  Model model_;
  std::unique_ptr<CpuSolver> solver_;
  Pose at_;
  bool was_ = false;
};

/// The stylus holds the needle at its tail.
constexpr double kReachAll_m = 0.02;
Scene sewnScene() {
  Scene out = sewnBlock(1);
  out.styluses[0].grab.radius_m = kReachAll_m;
  return out;
}

TEST(Needles, AToolDrivesOneThroughAndLetsItGo) {
  Sewing sewing(1, sewnScene());
  double most_n = 0, worst = 0;
  size_t most = 0;
  sewing.turn(0, 1.4 * kSewnPi, 0.05, [&](double) {
    most_n = std::max(most_n, sewing.force_n());
    most = std::max(most, sewing.needle().crossings());
    const Chain& chain = findProcess<SutureBodies>(sewing.solver())->chain(0);
    worst = std::max(worst, chain.worstLink());
    ASSERT_LT((chain.positions_m()[0] - sewing.needle().tail_m()).norm(), 1e-4);
  });
  EXPECT_GE(most, 5u);
  EXPECT_GE(findProcess<SutureBodies>(sewing.solver())->slides(0).size(), 2u);  // channels of the suture
  EXPECT_GT(most_n, 0.04);
  EXPECT_LT(most_n, 0.3);
  EXPECT_LT(worst, 1e-3);
  const Pose before = sewing.needle().pose();
  for (int i = 0; i < 30; ++i) sewing.tick(Sewing::toolAt(0), ToolMode::kNone);
  EXPECT_LT((sewing.needle().pose().position_m - before.position_m).norm(), 6e-3);  // tissue still holds its tail
  EXPECT_EQ(sewing.force_n(), 0);
  EXPECT_EQ(sewing.nonfinite, 0u);
  EXPECT_EQ(sewing.solver().health().trips, 0u);
}

/// A blade cuts the block along x = 0 while the needle is still above it, and its suture has no channel. Then the
/// needle is driven through both lips and turned out.
TEST(Needles, GoThroughBothLipsOfAWoundAndOutOfThem) {
  Scene scene = sewnScene();
  scene.environment.gravity_m_per_s2.setZero();
  BodyConfig& block = scene.bodies[0];
  block.material.prestress.strains = {0.08, 0, 0};  // the wound gapes
  StylusConfig knife;
  knife.button1 = ToolMode::kCut;
  scene.styluses.push_back(knife);
  Sewing sewing(1, scene);
  sewing.cutFrom({0, -0.0075, -0.0045}, {0, 0.0075, -0.0045});
  constexpr double kOut_rad = 1.9 * kSewnPi;  // its tail is still in tissue
  sewing.turn(0, kOut_rad, 0.05);
  double most_n = 0;
  for (int i = 1; i <= 30; ++i) {
    Pose up = Sewing::toolAt(kOut_rad);
    up.position_m += i * Vector3d(5e-4, 0, 5e-4);
    sewing.tick(up, ToolMode::kNeedle);
    most_n = std::max(most_n, sewing.force_n());
  }
  EXPECT_LT(most_n, 0.1);  // no channel clings to the tail
  EXPECT_EQ(sewing.needle().crossings(), 0u);
  size_t left = 0, right = 0;
  for (const ChainSlide& slide : findProcess<SutureBodies>(sewing.solver())->slides(0))
    (slide.to_m.x() < 0 ? left : right) += 1;
  EXPECT_GE(left, 2u);
  EXPECT_GE(right, 2u);
  EXPECT_EQ(sewing.nonfinite, 0u);
  EXPECT_EQ(sewing.solver().health().trips, 0u);
}

TEST(Needles, OneThatIsFreeHangsOnItsSuture) {
  Scene hanging = sewnScene();
  SutureConfig& suture = hanging.sutures[0];
  suture.path = {{{0.06, 0, 0.05}}};
  suture.position_m = {0.05, 0, 0.05};
  suture.end = SutureEnd::kFixed;
  Sewing sewing(1, hanging);
  for (int i = 0; i < 300; ++i) sewing.tick(Sewing::toolAt(0), ToolMode::kNone);
  EXPECT_LT((sewing.needle().tail_m() - Vector3d(0.06, 0, 0.04)).norm(), 1e-3);
  EXPECT_LT((sewing.needle().pose() * sewing.needle().shape().middle()).z(), 0.04);
  const NeedleShape& shape = sewing.needle().shape();
  EXPECT_NEAR(findProcess<SutureBodies>(sewing.solver())->chain(0).tension_n(5), shape.mass_kg() * 9.81,
              0.1 * shape.mass_kg() * 9.81);
}

TEST(Needles, AToolTakesOnlyWhatIsInReachAndAgainAtTheTip) {
  Scene near = sewnScene();
  near.styluses[0].grab.radius_m = 0.002;
  near.environment.gravity_m_per_s2.setZero();
  Sewing sewing(1, near);
  const auto move = [&](const Vector3d& from, const Vector3d& to, ToolMode mode) {
    sewing.tick({from, Quaterniond::Identity()}, ToolMode::kNone);
    sewing.tick({from, Quaterniond::Identity()}, mode);
    for (int i = 0; i < 3; ++i) sewing.tick({to, Quaterniond::Identity()}, mode);  // and does not move
    sewing.tick({to, Quaterniond::Identity()}, ToolMode::kNone);
  };
  const Vector3d tip(-kSewnArc_m, 0, kSewnAbove_m), aside(0, 0.003, 0), up(0, 0, 0.002);
  const auto tipNow = [&] { return Vector3d(sewing.needle().pose() * sewing.needle().shape().at(0)); };
  move(tip + aside, tip + aside + up, ToolMode::kNeedle);
  EXPECT_LT((tipNow() - tip).norm(), 1e-3);
  move(tip + 0.5 * aside, tip + 0.5 * aside + up, ToolMode::kNeedle);
  EXPECT_LT((tipNow() - tip - up).norm(), 1e-3);
}

TEST(Needles, StatesAreTheSameInEveryRunAndWithAnyNumberOfThreads) {
  Sewing one(1, sewnScene()), again(1, sewnScene()), four(4, sewnScene());
  for (Sewing* sewing : {&one, &again, &four}) sewing->turn(0, kSewnPi, 0.2);
  EXPECT_EQ(one.hash(), again.hash());
  EXPECT_EQ(one.hash(), four.hash());
}

TEST(Needles, GoOnFromASavedStateToTheBit) {
  Sewing first(1, sewnScene()), second(1, sewnScene());
  first.turn(0, kSewnPi, 0.2);
  first.tick(Sewing::toolAt(kSewnPi), ToolMode::kNeedle);
  second.turn(0, 0.2, 0.2);
  Archive saved;
  first.solver().persist(saved);
  Archive read(saved.sections());
  second.solver().persist(read);
  read.end();
  EXPECT_EQ(first.hash(), second.hash());
  first.turn(kSewnPi, 1.3 * kSewnPi, 0.2);
  second.toolIsAt(kSewnPi);
  second.turn(kSewnPi, 1.3 * kSewnPi, 0.2);
  EXPECT_GE(second.needle().crossings(), 3u);
  EXPECT_EQ(first.hash(), second.hash());
}

TEST(Needles, ResetPutsThemBack) {
  Sewing sewing(1, sewnScene()), fresh(1, sewnScene());
  const uint64_t before = sewing.hash();
  sewing.turn(0, kSewnPi, 0.2);
  EXPECT_NE(sewing.hash(), before);
  sewing.solver().reset();
  EXPECT_EQ(sewing.hash(), before);
}

}  // namespace
}  // namespace viscera
