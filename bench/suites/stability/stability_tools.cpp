// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <random>

#include "bench/suites/stability/stability_suite.h"
#include "bench/suites/stability/stability_trial.h"
#include "viscera/tools/tools.h"

namespace viscera::bench {

namespace {

constexpr double kStabilityToolsSpacing_m = 0.005;
constexpr double kTop_m = 0.02;      // top of the block
constexpr double kBackWithin = 0.1;  // relative to the spacing: closer tissue counts as recovered
constexpr double kSpeedLimit = 5;    // relative to the tool's speed or c_p
constexpr int kTicksPerSecond = 60;
constexpr unsigned kStabilityToolsSeed = 3;
constexpr const char* kThrough = "probe through the block";

/// A block fixed at its bottom and one stylus, as in a session, without surface mesh and images.
class Stage {
 public:
  Stage(Backend backend, ToolMode mode, Law law, const Vector3i& cells)
      : model_(blockOf(law, cells)),
        scene_(sceneWith(mode)),
        solver_(solverOn(backend, model_, scene_)),
        tools_(scene_.styluses, {waveSpeed(model_) / scene_.solver.tick_hz}) {}

  void moveTo(const Vector3d& tip) {
    sample_[0].valid = true;
    sample_[0].pose.position_m = tip;
    tick();
  }
  void turn(const Quaterniond& orientation) { sample_[0].pose.orientation = orientation; }
  void takeAway() {
    sample_[0].valid = false;
    tick();
  }
  /// Moves the tip from one position to another at a speed.
  void sweep(const Vector3d& from, const Vector3d& to, double speed) {
    const int ticks = std::max(1, static_cast<int>(std::ceil((to - from).norm() / speed * kTicksPerSecond)));
    for (int t = 1; t <= ticks; ++t) moveTo(from + static_cast<double>(t) / ticks * (to - from));
  }
  void rest(double seconds) {
    for (int t = 0; t < seconds * kTicksPerSecond; ++t) takeAway();
  }
  /// Returns the largest displacement from rest, over the spacing.
  double strayed() const {
    const HostState state = solver_->readState();
    double farthest = 0;
    for (uint32_t slot : model_.bodies[0].lattice.active_slots) {
      farthest = std::max(farthest, xyz(state.displacement_m[slot]).norm());
    }
    return farthest / kStabilityToolsSpacing_m;
  }
  const Model& model() const { return model_; }
  const layout::TickStats& stats() const { return stats_; }
  const TissueStepper& solver() const { return *solver_; }
  double peak_speed = 0, peak_stretch = 0;
  int speed_limited = 0;
  bool finite = true;

 private:
  static Model blockOf(Law law, const Vector3i& cells) {
    MaterialConfig material;
    material.law = law;
    return blockModel(cells, kStabilityToolsSpacing_m, material, [](const Vector3i& node) { return node.z() == 0; });
  }
  static Scene sceneWith(ToolMode mode) {
    Scene scene;
    StylusConfig stylus;
    stylus.idle = mode;
    stylus.cut.blade_length_m = 0.05;
    stylus.cut.blade_side = BladeSide::kAhead;
    scene.styluses.push_back(stylus);
    scene.environment.gravity_m_per_s2 = Vector3d::Zero();
    scene.solver.tick_hz = kTicksPerSecond;
    return scene;
  }
  void tick() {
    const ToolMotions motions = tools_.advance(sample_);
    speed_limited += motions[0].speed_limited;
    solver_->step(motions);
    while (solver_->pollStats(stats_, true)) {
    }
    const auto number = [](uint32_t bits) {
      float value;
      std::memcpy(&value, &bits, sizeof value);
      return static_cast<double>(value);
    };
    peak_speed = std::max(peak_speed, number(stats_.max_speed_bits));
    peak_stretch = std::max(peak_stretch, number(stats_.max_stretch_bits));
    const layout::vec4& f = stats_.impulse[0];
    finite = finite && stats_.nonfinite == 0 && std::isfinite(f.x + f.y + f.z) && std::isfinite(peak_speed);
  }

  Model model_;
  Scene scene_;
  std::unique_ptr<TissueStepper> solver_;
  Tools tools_;
  StylusSamples sample_;
  layout::TickStats stats_{};
};

/// One row of the table of abuses, and the data of its checks.
struct Abuse {
  std::string name;
  double tool_speed;
  std::function<void(Stage&)> act;
  ToolMode mode = ToolMode::kProbe;
};

void teleport(Stage& stage, int ticks) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> across(-0.05, 0.08), height(0.005, 0.08);
  for (int t = 0; t < ticks; ++t) stage.moveTo({across(random), across(random), height(random)});
}

void pullTenfold(Stage& stage, double speed) {
  const Vector3d grip(0.015, 0.015, kTop_m), far(0.015, 0.015, 10 * kTop_m);
  stage.moveTo(grip);
  stage.sweep(grip, far, speed);
  for (int t = 0; t < kTicksPerSecond / 5; ++t) stage.moveTo(far);
}

std::vector<Abuse> abuses(bool short_form) {
  std::vector<Abuse> out;
  const std::vector<double> speeds =
      short_form ? std::vector<double>{1, 100} : std::vector<double>{0.01, 0.1, 1, 10, 100};
  for (double speed : speeds) {
    out.push_back({kThrough, speed, [speed](Stage& stage) {
                     const Vector3d above(0.014, 0.016, 0.032), inside(0.014, 0.016, 0.012), out_of(0.06, 0.016, 0.012);
                     stage.moveTo(above);
                     stage.sweep(above, inside, speed);
                     stage.sweep(inside, out_of, speed);
                   }});
  }
  out.push_back({"probe that jumps every tick", 0.08 * kTicksPerSecond,
                 [short_form](Stage& s) { teleport(s, short_form ? 20 : 120); }});
  out.push_back({"grab that jumps every tick", 0.08 * kTicksPerSecond,
                 [short_form](Stage& s) {
                   s.moveTo({0.015, 0.015, kTop_m});
                   teleport(s, short_form ? 20 : 120);
                 },
                 ToolMode::kGrab});
  for (double speed : {1.0, 100.0}) {
    out.push_back({"grab pulled to 10x", speed, [speed](Stage& s) { pullTenfold(s, speed); }, ToolMode::kGrab});
  }
  return out;
}

/// Data for the checks of all abuses on one backend.
struct Abused {
  int not_finite = 0, not_back = 0, not_said = 0;
  double worst_speed = 0;
};

/// Runs the abuses, with the points of the plot: nodes' speeds under the probe, and their limit.
Abused abuseOn(Backend backend, Report& report, Table& table, Series& peaks, Series& limits) {
  Abused out;
  for (const Abuse& abuse : abuses(report.isShort())) {
    report.stage(abuse.name + ", " + nameOf(backend));
    Stage stage(backend, abuse.mode, Law::kNeoHookean, Vector3i(6, 6, 4));
    abuse.act(stage);
    stage.rest(1);
    const double fastest = std::max(abuse.tool_speed, waveSpeed(stage.model()));
    const double speed = stage.peak_speed / fastest, away = stage.strayed();
    const bool back = away < kBackWithin, said = stage.solver().health().strained;
    out.not_finite += stage.finite ? 0 : 1;
    if (abuse.mode == ToolMode::kProbe) {
      out.not_back += back ? 0 : 1;
    } else {
      out.not_said += back || said ? 0 : 1;
    }
    out.worst_speed = worse(out.worst_speed, speed);
    if (abuse.name == kThrough) {
      peaks.x.push_back(abuse.tool_speed), peaks.y.push_back(stage.peak_speed);
      limits.x.push_back(abuse.tool_speed), limits.y.push_back(kSpeedLimit * fastest);
    }
    table.add({nameOf(backend), abuse.name, abuse.tool_speed, stage.speed_limited, stage.finite ? "yes" : "NO",
               stage.peak_speed, speed, stage.peak_stretch, static_cast<double>(stage.solver().health().trips), away,
               back   ? "yes"
               : said ? "bounded, strained"
                      : "bounded"});
  }
  return out;
}

void abuseTissue(Report& report) {
  Table table("effect of tools on a block of the neo-Hookean law held at its bottom, and one second later",
              {{"backend"},
               {"abuse"},
               {"tool speed", "m/s"},
               {"ticks held back"},
               {"finite"},
               {"peak node speed", "m/s"},
               {"over tool or c_p"},
               {"peak stretch"},
               {"stability monitor trips"},
               {"away after 1 s", "h"},
               {"back"}});
  Plot plot{"effect of a probe on nodes, by its speed", "tool speed [m/s]", "peak node speed [m/s]", true, true, {}};
  Series limits;
  for (Backend backend : report.backends()) {
    Series peaks{nameOf(backend) + ": peak node speed", {}, {}};
    limits = {"5 times tool or c_p", {}, {}, Series::Style::kLines};
    const Abused found = abuseOn(backend, report, table, peaks, limits);
    plot.series.push_back(peaks);
    const std::string name = nameOf(backend) + ": tools: ";
    report.checkAtMost(name + "sessions with a value that is not finite", found.not_finite, 0);
    report.checkAtMost(name + "peak node speed over the tool's or c_p", found.worst_speed, kSpeedLimit);
    report.checkAtMost(name + "probed tissue that is not back after 1 s", found.not_back, 0);
    report.checkAtMost(name + "grabbed tissue that stays folded without being reported as strained", found.not_said, 0);
  }
  plot.series.push_back(limits);
  report.add(table, "tools");
  report.add(plot, "tools");
}

/// Cuts the block by random strokes until it is in pieces.
void cutToPieces(Report& report) {
  const int strokes = report.isShort() ? 300 : 10000;
  Table table("random cuts through a block of springs", {{"backend"},
                                                         {"springs"},
                                                         {"strokes"},
                                                         {"springs cut"},
                                                         {"finite"},
                                                         {"peak node speed", "m/s"},
                                                         {"stability monitor trips"},
                                                         {"dt_safe grew by"}});
  for (Backend backend : report.backends()) {
    std::srand(kStabilityToolsSeed);  // for UnitRandom()
    Stage stage(backend, ToolMode::kCut, Law::kSprings, Vector3i(5, 5, 5));
    std::mt19937 random(kStabilityToolsSeed);
    std::uniform_real_distribution<double> position(-0.005, 0.03);
    for (int i = 0; i < strokes; ++i) {
      stage.turn(Quaterniond::UnitRandom());
      stage.moveTo({position(random), position(random), position(random)});
      if (i % 1000 == 0) report.stage("random cuts, stroke " + std::to_string(i) + ", " + nameOf(backend));
    }
    const double springs = static_cast<double>(stage.model().springs());
    table.add({nameOf(backend), springs, strokes, static_cast<double>(stage.stats().springs_cut),
               stage.finite ? "yes" : "NO", stage.peak_speed, static_cast<double>(stage.solver().health().trips),
               stage.solver().dtSafe_s() / safeTimeStep(stage.model())});
    report.checkAtMost(nameOf(backend) + ": cuts: values that are not finite", stage.finite ? 0 : 1, 0);
    if (report.isShort()) continue;  // some springs are left
    report.checkAtMost(nameOf(backend) + ": cuts: springs left", springs - stage.stats().springs_cut, 0);
  }
  report.add(table, "cuts");
}

}  // namespace

void toolsOfStability(Report& report) {
  abuseTissue(report);
  cutToPieces(report);
}

}  // namespace viscera::bench
