// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites/blade/blade_strokes.h"

#include <algorithm>
#include <random>

#include "math/decompositions.h"
#include "solver/cpu/cpu_solver.h"
#include "solver/processes/blade/blades.h"
#include "viscera/model/model.h"
#include "viscera/model/scene/scene.h"

namespace viscera::bench {

namespace {

constexpr double kBack_j = 1e-3;  // largest energy returned to the user in a stroke [J]
constexpr int kStrokes = 10000, kStrokesShort = 500;
constexpr int kTissueLasts = 20;  // strokes after which the tissue is reset
constexpr double kAway_m = 0.08;  // distance at which the motion is reversed [m]
constexpr double kKilo = 1e3, kBladeStrokesMilli = 1e-3;

/// Returns a block on a plate, otherwise free.
Scene blockOf(double young_modulus_pa, double toughness_j_per_m2) {
  Scene scene;
  BodyConfig body;
  body.source = TissueSource::kBox;
  body.box_size_m = {0.04, 0.04, 0.02};
  body.spacing_m = 0.004;
  body.material.young_modulus_pa = young_modulus_pa;
  body.material.cut.toughness_j_per_m2 = toughness_j_per_m2;
  FixedConfig plate;
  plate.min_m = {-1, -1, -1};
  plate.max_m = {1, 1, -0.0099};
  body.fixed.push_back(plate);
  scene.bodies.push_back(body);
  StylusConfig stylus;
  stylus.idle = ToolMode::kCut;
  scene.styluses.push_back(stylus);
  scene.solver.backend = Backend::kCpu;
  return scene;
}

/// Random strokes: they start anywhere, move in any direction at up to 1 m/s per axis, and often reverse.
class Strokes {
 public:
  explicit Strokes(const Scene& scene) : scene_(scene), model_(buildModel(scene)), solver_(model_, scene) {}

  void make(int strokes) {
    for (int k = 0; k < strokes; ++k) {
      if (k % kTissueLasts == 0) solver_.reset();
      const double before_j = bladeWork(solver_, 0).work_j;
      least_j_ = before_j;
      stroke();
      solver_.step(ToolMotions{});
      work_j += bladeWork(solver_, 0).work_j - before_j;
      back_j = std::max(back_j, before_j - bladeWork(solver_, 0).work_j);
      back_at_once_j = std::max(back_at_once_j, before_j - least_j_);
    }
    trips = static_cast<double>(solver_.health().trips);
  }

  double work_j = 0, back_j = 0, back_at_once_j = 0, nonfinite = 0, trips = 0;

 private:
  double any() { return any_(random_); }

  void stroke() {
    const double tick_s = 1 / scene_.solver.tick_hz;
    Pose pose;
    pose.position_m = {0.03 * any(), 0.03 * any(), 0.012 * any()};
    const Vector3d axis{any(), any(), 1.2 * any()};
    pose.orientation = rotationBetween(Vector3d::UnitZ(), axis.normalized());
    Vector3d velocity{any(), any(), 0.5 * any()};
    const auto ticks = 4 + random_() % 12;
    const Quaterniond turn(Eigen::AngleAxisd(0.05 * any(), Vector3d::UnitX()));
    for (unsigned tick = 0; tick < ticks; ++tick) {
      ToolMotions motions;
      motions[0].mode = ToolMode::kCut;
      motions[0].present = true;
      motions[0].from = pose;
      pose.position_m += tick_s * velocity;
      pose.orientation = turn * pose.orientation;
      motions[0].to = pose;
      if (random_() % 7 == 0) velocity = -velocity;
      if (pose.position_m.norm() > kAway_m) velocity = -velocity;
      solver_.step(motions);
      layout::TickStats stats;
      while (solver_.pollStats(stats, true)) nonfinite += stats.nonfinite;
      least_j_ = std::min(least_j_, bladeWork(solver_, 0).work_j);
    }
  }

  Scene scene_;
  Model model_;
  CpuSolver solver_;
  std::mt19937 random_{1};
  std::uniform_real_distribution<double> any_{-1, 1};
  double least_j_ = 0;
};

}  // namespace

void bladeStrokes(Report& report) {
  Table table("Random strokes at up to 1 m/s", {{"strokes", "", 5},
                                                {"E", "kPa"},
                                                {"J", "J/m2"},
                                                {"mean work", "mJ", 3},
                                                {"back in a stroke", "mJ", 2},
                                                {"back at any time", "mJ", 2},
                                                {"not finite"},
                                                {"trips"}});
  const int count = report.isShort() ? kStrokesShort : kStrokes;
  const double young_modulus_pa = 10e3, toughness_j_per_m2 = 200;
  report.stage(std::to_string(count) + " strokes");
  Strokes strokes(blockOf(young_modulus_pa, toughness_j_per_m2));
  strokes.make(count);
  table.add({count, young_modulus_pa / kKilo, toughness_j_per_m2, strokes.work_j / count / kBladeStrokesMilli,
             strokes.back_j / kBladeStrokesMilli, strokes.back_at_once_j / kBladeStrokesMilli, strokes.nonfinite,
             strokes.trips});
  report.add(table, "strokes");
  report.checkAtMost("energy given to the device in a stroke", strokes.back_j, kBack_j);
  report.checkAtMost("energy given to the device at any time of a stroke", strokes.back_at_once_j, kBack_j);
  report.checkAtMost("not finite", strokes.nonfinite, 0);
  report.checkAtMost("trips", strokes.trips, 0);
}

}  // namespace viscera::bench
