// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites/blade/blade_curves.h"

#include <algorithm>
#include <string>
#include <vector>

#include "math/decompositions.h"
#include "model/fracture/toughness.h"
#include "model/scene/tissue_presets.h"
#include "solver/cpu/cpu_solver.h"
#include "solver/processes/blade/blades.h"
#include "viscera/model/model.h"
#include "viscera/model/scene/scene.h"

namespace viscera::bench {

namespace {

constexpr double kTick_hz = 240, kClear_m = 0.001, kMilli = 1e-3;
// Limits of a needle's force behind the capsule, relative to the first peak: published 0.3; toughness and friction
// there give 0.15.
constexpr double kMostLeft = 0.5, kLeastLeft = 0.1;
constexpr double kAllCarried = 0.99;  // share of the capsule's toughness that the lattice represents

/// A force along the stroke.
struct Moment {
  double time_s, gone_m, force_n;
};

/// Returns a block fixed at its bottom and sides; its top is at z = 0.
Scene blockOf(const Vector3d& size_m, double spacing_m, const char* tissue, const StylusConfig& stylus) {
  Scene scene;
  BodyConfig body;
  body.source = TissueSource::kBox;
  body.box_size_m = size_m;
  body.position_m.z() = -0.5 * size_m.z();
  body.spacing_m = spacing_m;
  body.material.tissue = tissue;
  takeTissue(body.material);
  body.material.poisson_ratio = 0.45;
  body.material.cut.toughness_j_per_m2 = tissueNamed(tissue)->toughness_j_per_m2;
  const Vector3d half = 0.5 * size_m, thin = Vector3d::Constant(0.1 * spacing_m), all = half + thin;
  for (const Vector3d& side :
       {Vector3d(0, 0, -1), Vector3d(1, 0, 0), Vector3d(-1, 0, 0), Vector3d(0, 1, 0), Vector3d(0, -1, 0)}) {
    FixedConfig fixed;
    fixed.min_m = (side.array() > 0).select(half - thin, -all);
    fixed.max_m = (side.array() < 0).select(-half + thin, all);
    body.fixed.push_back(fixed);
  }
  scene.bodies.push_back(body);
  scene.styluses.push_back(stylus);
  scene.styluses[0].idle = ToolMode::kCut;
  scene.environment.gravity_m_per_s2.setZero();
  scene.solver.tick_hz = kTick_hz;
  scene.solver.backend = Backend::kCpu;
  scene.solver.sleep_speed_m_per_s = 0;
  return scene;
}

class Tool {
 public:
  Tool(const Scene& scene, const Pose& pose) : model_(buildModel(scene)), solver_(model_, scene), at_(pose) {}

  void go(const Vector3d& offset_m, double speed_m_per_s) {
    const int ticks = std::max(1, static_cast<int>(offset_m.norm() / speed_m_per_s * kTick_hz));
    for (int i = 0; i < ticks; ++i) {
      ToolMotions motions;
      motions[0].mode = ToolMode::kCut;
      motions[0].present = true;
      motions[0].from = at_;
      at_.position_m += offset_m / ticks;
      motions[0].to = at_;
      solver_.step(motions);
      layout::TickStats stats;
      while (solver_.pollStats(stats, true)) last_ = stats;
      const Vector3d impulse(last_.impulse[0].x, last_.impulse[0].y, last_.impulse[0].z);
      gone_m_ += offset_m.norm() / ticks;
      time_s_ += 1 / kTick_hz;
      moments_.push_back({time_s_, gone_m_, kTick_hz * impulse.norm()});
    }
  }
  const std::vector<Moment>& moments() const { return moments_; }
  const Model& model() const { return model_; }
  double trips() const { return static_cast<double>(solver_.health().trips); }
  BladeWork work() const { return bladeWork(solver_, 0); }

 private:
  Model model_;
  CpuSolver solver_;
  Pose at_;
  double gone_m_ = 0, time_s_ = 0;
  layout::TickStats last_{};
  std::vector<Moment> moments_;
};

Moment largest(const std::vector<Moment>& moments, double from_m, double to_m) {
  Moment out{0, 0, -1e300};
  for (const Moment& m : moments) {
    if (m.gone_m >= from_m && m.gone_m < to_m && m.force_n > out.force_n) out = m;
  }
  return out;
}

/// Returns the smallest mean over a millimetre, since a force that changes direction is 0 for a moment.
Moment leastAfter(const std::vector<Moment>& moments, double from_m, double to_m) {
  constexpr double kMean_m = 0.001;
  Moment out{0, 0, 1e300};
  for (size_t first = 0; first < moments.size(); ++first) {
    double sum_n = 0;
    size_t end = first;
    for (; end < moments.size() && moments[end].gone_m < moments[first].gone_m + kMean_m; ++end)
      sum_n += moments[end].force_n;
    const double mean_n = sum_n / static_cast<double>(end - first);
    if (moments[first].gone_m <= from_m || moments[end - 1].gone_m >= to_m || mean_n >= out.force_n) continue;
    out = moments[first];
    out.force_n = mean_n;
  }
  return out;
}

/// A needle of 1.3 mm in a liver with a capsule and a second membrane, with a published curve.
struct Published {
  static constexpr double kWidth_m = 0.0013, kFriction_n_per_m = 42, kInside = 76, kCapsule = 1085, kMembrane = 1315;
  static constexpr double kDeep_m = 0.036;
  static constexpr double kFirst_n = 1.41, kFirst_m = 0.01915, kThen_n = 0.42, kSecond_n = 2.32, kSecond_m = 0.0367;
};

Tool pricked(double spacing_m) {
  StylusConfig needle;
  needle.cut.blade_length_m = 0.08;
  needle.cut.friction_n_per_m = Published::kFriction_n_per_m;
  needle.cut.point_width_m = Published::kWidth_m;
  Scene scene = blockOf({0.064, 0.064, 0.056}, spacing_m, "liver", needle);
  BodyConfig& body = scene.bodies[0];
  body.material.cut.toughness_j_per_m2 = Published::kInside;
  body.layers = {{0.001, Vector3d::Ones(), Published::kCapsule},
                 {0.0145, Vector3d::Ones(), 0},
                 {0.0175, Vector3d::Ones(), Published::kMembrane}};
  Tool tool(scene, {{0.0013, 0.0007, kClear_m}, Quaterniond::Identity()});
  tool.go({0, 0, -Published::kDeep_m - kClear_m}, 0.05);
  return tool;
}

Series curveOf(const std::string& name, const std::vector<Moment>& moments, bool over_time) {
  Series out;
  out.name = name;
  out.style = Series::Style::kLines;
  for (const Moment& m : moments) {
    out.x.push_back(over_time ? m.time_s : (m.gone_m - kClear_m) / kMilli);
    out.y.push_back(m.force_n);
  }
  return out;
}

}  // namespace

void bladeOnset(Report& report) {
  Table table("A needle of 1.3 mm in liver, compared with the published curve", {{"h", "mm"},
                                                                                 {"capsule carried", "", 2},
                                                                                 {"first peak", "N", 3},
                                                                                 {"at", "mm", 3},
                                                                                 {"then", "N", 2},
                                                                                 {"second peak", "N", 3},
                                                                                 {"at", "mm", 3},
                                                                                 {"at 36 mm", "N", 3},
                                                                                 {"trips"}});
  Plot plot;
  plot.title = "a needle of 1.3 mm is pushed into liver";
  plot.x_label = "depth of the point below the surface [mm]";
  plot.y_label = "force [N]";
  for (const double spacing_m : {0.004, 0.0028, 0.002}) {
    if (report.isShort() && spacing_m < 0.004) continue;
    const std::string name = "h " + Cell(spacing_m / kMilli).text(2) + " mm";
    report.stage("onset, " + name);
    const Tool tool = pricked(spacing_m);
    const std::vector<Moment>& moments = tool.moments();
    Toughness capsule = toughnessOf(tool.model().bodies[0]);
    capsule.asked_j_per_m2 = Published::kCapsule;
    const double carried = capsule.ofPoint_n(Published::kWidth_m, capsule.pointKernel_m(Published::kWidth_m)) /
                           (Published::kCapsule * Published::kWidth_m);
    const Moment first = largest(moments, 0, 0.013), then = leastAfter(moments, first.gone_m, first.gone_m + 0.006),
                 second = largest(moments, then.gone_m + 0.004, 0.028);
    table.add({spacing_m / kMilli, carried, first.force_n, (first.gone_m - kClear_m) / kMilli, then.force_n,
               second.force_n, (second.gone_m - kClear_m) / kMilli, moments.back().force_n, tool.trips()});
    plot.series.push_back(curveOf(name, moments, false));
    report.checkAtMost("trips, needle, " + name, tool.trips(), 0);
    report.checkAtMost("drop after the first peak, " + name, then.force_n / first.force_n, kMostLeft);
    if (carried > kAllCarried)
      report.checkAtLeast("left after the first peak, " + name, then.force_n / first.force_n, kLeastLeft);
  }
  table.add({Cell("published"), Cell(""), Published::kFirst_n, Published::kFirst_m / kMilli, Published::kThen_n,
             Published::kSecond_n, Published::kSecond_m / kMilli, Cell("1.45 to 1.6 after it"), Cell("")});
  Series published;
  published.name = "published";
  published.style = Series::Style::kPoints;
  published.x = {Published::kFirst_m / kMilli, Published::kFirst_m / kMilli, Published::kSecond_m / kMilli};
  published.y = {Published::kFirst_n, Published::kThen_n, Published::kSecond_n};
  plot.series.push_back(published);
  report.add(table, "onset");
  report.add(plot, "onset");
}

void bladeTool(Report& report) {
  Table table("A blade is pressed 10 mm into 40 mm of tissue and drawn 24 mm along itself, 4 mm deeper",
              {{"tissue"},
               {"J", "J/m2"},
               {"carried", "", 2},
               {"pressed, most", "N", 3},
               {"drawn, mean", "N", 3},
               {"area", "mm2", 3},
               {"trips"}});
  Plot plot;
  plot.title = "a blade in 40 mm of tissue is pressed down, drawn, and lifted";
  plot.x_label = "time [s]";
  plot.y_label = "force [N]";
  for (const char* tissue : {"liver", "fat", "skin"}) {
    report.stage(std::string("hand in ") + tissue);
    StylusConfig knife;
    knife.cut.blade_length_m = 0.08;
    const Quaterniond lies = rotationBetween(Vector3d::UnitZ(), -Vector3d::UnitX());
    const Scene scene = blockOf({0.04, 0.048, 0.036}, report.isShort() ? 0.004 : 0.003, tissue, knife);
    Tool tool(scene, {{0.022, 0.0004, kClear_m}, lies});
    tool.go({0, 0, -0.01 - kClear_m}, 0.03);
    const size_t pressed = tool.moments().size();
    tool.go({0.024, 0, -0.004}, 0.06);
    const size_t drawn = tool.moments().size();
    tool.go({0, 0, 0.03}, 0.06);
    const std::vector<Moment>& moments = tool.moments();
    double most_n = 0, sum_n = 0;
    for (size_t i = 0; i < drawn; ++i) {
      if (i < pressed) most_n = std::max(most_n, moments[i].force_n);
      if (i >= pressed) sum_n += moments[i].force_n / static_cast<double>(drawn - pressed);
    }
    const Toughness toughness = toughnessOf(tool.model().bodies[0]);
    table.add({Cell(tissue), toughness.asked_j_per_m2, toughness.carried_j_per_m2() / toughness.asked_j_per_m2, most_n,
               sum_n, 1e6 * tool.work().area_m2, tool.trips()});
    plot.series.push_back(curveOf(tissue, moments, true));
    report.checkAtMost(std::string("trips, hand in ") + tissue, tool.trips(), 0);
  }
  report.add(table, "hand");
  report.add(plot, "hand");
}

}  // namespace viscera::bench
