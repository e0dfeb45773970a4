// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <chrono>
#include <cmath>
#include <thread>

#include "bench/harness/machine/busy_processes.h"
#include "bench/harness/specimens/specimen.h"
#include "bench/suites/pace/performance_suites.h"
#include "calibration/timed_ticks.h"
#include "math/processors.h"
#include "solver/cpu/cpu_solver.h"

namespace viscera::bench {

namespace {

using Clock = std::chrono::steady_clock;

// Least rates of two threads on two cores, relative to an idle machine. One competing thread of low priority takes next
// to nothing; two of equal priority leave half.
constexpr double kBesideLow = 0.9, kBesideTwo = 0.45;
// Least ratio of two threads to one under the same load. Two should be no slower, except for the cost of trying the
// other number (thread_count_tuner.h) and the variation between two measurements under load.
constexpr double kAlone = 0.95;
constexpr double kSettle_s = 0.3;  // time for the system to distribute new processes over the cores
constexpr int kRounds = 2;
constexpr double kWarmUp_s = 1.5;  // time for the heart to sag and oscillate as later
constexpr double kSwing_m = 0.002, kDepth_m = 0.003, kTurn = 6.283185307179586;

struct Busy {
  Load load;
  double least_of_idle = 0;  ///< for two threads; 0: not checked
};

std::vector<Busy> loadsOf(bool short_form) {
  std::vector<Busy> out = {
      {{"none"}}, {{"one of lowest priority", 1, 19}, kBesideLow}, {{"two of normal priority", 2, 0}, kBesideTwo}};
  if (short_form) return out;
  out.push_back({{"one of normal priority", 1, 0}});
  out.push_back({{"one of lowest priority, other terminal", 1, 19, true}});
  return out;
}

/// Returns the scene `heart` of the demo.
Scene demoScene() {
  Scene scene = pigHeartScene(1000, 0.1);
  BodyConfig heart;
  heart.name = "heart";
  heart.source = TissueSource::kPhantom;
  heart.phantom_length_m = 0.1;
  heart.spacing_m = 0.005;
  heart.skin_spacing_m = 0.003;
  heart.fixed = scene.bodies[0].fixed;
  scene.bodies[0] = heart;
  return scene;
}

/// The scene with a number of threads and a probe that moves in and out of the heart's side.
class Stepping {
 public:
  Stepping(const Model& model, Scene scene, int threads, std::string name) : name_(std::move(name)) {
    scene.solver.threads = threads;
    solver_ = std::make_unique<CpuSolver>(model, scene);
    tick_s_ = 1 / scene.solver.tick_hz;
    side_m_ = farthestNode(model, solver_->readState(), Vector3d::UnitX()) +
              scene.styluses[0].probe.radius_m * Vector3d::UnitX();
    tip_m_ = tipAt(0);
  }
  const std::string& name() const { return name_; }
  /// Steps for some time on the clock.
  void run(double seconds) {
    const uint64_t before = solver_->substepsDone();
    const Clock::time_point start = Clock::now();
    std::chrono::duration<double> took{0};
    while (took.count() < seconds) {
      tick();
      took = Clock::now() - start;
    }
    seconds_ += took.count();
    substeps_ += static_cast<double>(solver_->substepsDone() - before);
  }
  /// Returns the substeps per second since the last call.
  double takeRate() {
    const double rate = substeps_ / seconds_;
    substeps_ = seconds_ = 0;
    return rate;
  }

 private:
  Vector3d tipAt(double time_s) const {
    return side_m_ - (kDepth_m - kSwing_m * std::cos(kTurn * time_s)) * Vector3d::UnitX();
  }
  void tick() {
    ToolMotions motions = probeAt(tip_m_);
    tip_m_ = tipAt(++ticks_ * tick_s_);
    motions[0].to.position_m = tip_m_;
    stepAndWait(*solver_, motions);
  }

  std::string name_;
  std::unique_ptr<CpuSolver> solver_;
  double tick_s_ = 0, substeps_ = 0, seconds_ = 0;
  int ticks_ = 0;
  Vector3d side_m_, tip_m_;
};

/// Returns the substeps per second of each, measured in turn.
std::vector<double> ratesOf(std::vector<Stepping>& variants, double seconds) {
  for (int round = 0; round < kRounds; ++round) {
    for (Stepping& variant : variants) variant.run(seconds);
  }
  std::vector<double> rates;
  for (Stepping& variant : variants) rates.push_back(variant.takeRate());
  return rates;
}

}  // namespace

void busySuite(Report& report) {
  const Scene scene = demoScene();
  report.stage("building");
  const Model model = buildModel(scene);
  const int there = usableProcessors();
  std::vector<Stepping> variants;
  variants.emplace_back(model, scene, 1, "1 thread");
  variants.emplace_back(model, scene, 2, "2 threads");
  variants.emplace_back(model, scene, 0, "auto (" + std::to_string(there) + ")");
  const double seconds = report.isShort() ? 0.1 : 2.5;
  for (Stepping& variant : variants) {
    variant.run(report.isShort() ? seconds : kWarmUp_s);
    variant.takeRate();
  }
  Table table(
      "heart of " + std::to_string(model.activeNodes()) + " nodes with a probe in it, next to busy processes, on " +
          std::to_string(there) + " processors",
      {{"busy processes"}, {"stepped by"}, {"rate", "substeps/s", 3}, {"over idle", "", 2}, {"over 1 thread", "", 2}});
  std::vector<double> idle;
  for (const Busy& busy : loadsOf(report.isShort())) {
    report.stage("beside: " + busy.load.name);
    const BusyProcesses processes(busy.load);
    if (busy.load.processes > 0) std::this_thread::sleep_for(std::chrono::duration<double>(kSettle_s));
    const std::vector<double> rates = ratesOf(variants, seconds);
    if (idle.empty()) idle = rates;
    for (size_t w = 0; w < variants.size(); ++w)
      table.add({busy.load.name, variants[w].name(), rates[w], rates[w] / idle[w], rates[w] / rates[0]});
    if (busy.least_of_idle > 0)
      report.checkAtLeast("2 threads beside " + busy.load.name + ", over idle", rates[1] / idle[1], busy.least_of_idle);
    if (busy.load.processes > 0)
      report.checkAtLeast("2 threads over 1, beside " + busy.load.name, rates[1] / rates[0], kAlone);
  }
  report.add(table, "rates");
}

}  // namespace viscera::bench
