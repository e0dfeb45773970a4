// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/command/reference.h"

#include <algorithm>
#include <chrono>
#include <iostream>
#include <optional>

#include "cli/run_metrics.h"
#include "cli/run_plan.h"
#include "cli/scene_lookup.h"
#include "math/one_line.h"
#include "solver/gpu/gpu_solver.h"
#include "solver/reference/reference_ticks.h"
#include "viscera/gpu/context.h"
#include "viscera/math/error.h"
#include "viscera/tools/obstacles.h"
#include "viscera/tools/tools.h"

namespace viscera::bench {

namespace {

using Clock = std::chrono::steady_clock;

/// The GPU solver over the same ticks. The stability monitor is off, so that it takes the same substeps.
class Comparison {
 public:
  Comparison(const Model& model, Scene scene)
      : context_(scene.solver.device), solver_(model, ungoverned(std::move(scene))) {}
  void step(const ToolMotions& motions, const ObstacleMotions& obstacles) { solver_.step(motions, obstacles); }

  /// Returns the largest nodal error of displacement relative to the largest displacement.
  double error(const ReferenceSolver& truth) const {
    const HostState state = solver_.readState();
    double error = 0, largest = 0;
    for (uint32_t slot : truth.active) {
      const layout::vec4& u = state.displacement_m[slot];
      error = std::max(error, (Vector3d(u.x, u.y, u.z) - truth.u_m[slot]).norm());
      largest = std::max(largest, truth.u_m[slot].norm());
    }
    return largest > 0 ? error / largest : error;
  }

 private:
  static Scene ungoverned(Scene scene) {
    scene.solver.stability_monitor = false;
    return scene;
  }
  gpu::Context context_;
  GpuSolver solver_;
};

void keepWorst(const ReferenceTicks& reference, double tick_hz, Extremes& worst) {
  for (uint32_t s = 0; s < layout::kMaxStyluses; ++s)
    worst.peak_force_n = std::max(worst.peak_force_n, reference.impulse(s).norm() * tick_hz);
  worst.max_stretch = std::max(worst.max_stretch, reference.maxStretch());
  worst.max_speed_m_per_s = std::max(worst.max_speed_m_per_s, reference.maxSpeed_m_per_s());
  worst.nonfinite = std::max(worst.nonfinite, reference.nonfinite());
}

}  // namespace

int referenceRun(const ReferenceRunOptions& options) {
  const cli::RunPlan plan = cli::planRun(options.run);
  const Progress progress = cli::consoleProgress();
  const Model model = buildModel(plan.scene, progress);
  for (const Body& body : model.bodies) {
    for (const std::string& note : body.notes) std::cout << body.name << ": " << oneLine(note) << '\n';
  }
  Strokes strokes = plan.strokes;
  resolveAnchors(strokes, model, plan.scene.fit);
  const double tick_hz = plan.scene.solver.tick_hz;
  Tools tools(plan.scene.styluses, {waveSpeed(model) / tick_hz});
  Obstacles obstacles(plan.scene.obstacles, waveSpeed(model) / tick_hz);
  ReferenceTicks reference(model, plan.scene);
  std::optional<Comparison> comparison;
  if (options.compare) comparison.emplace(model, plan.scene);

  cli::RunMetrics metrics{plan.scene.name, model};
  const Clock::time_point start = Clock::now();
  for (uint64_t t = 0; t < plan.ticks; ++t) {
    const double time_s = static_cast<double>(t + 1) / tick_hz;
    if (strokes.inputReset(t + 1)) tools.clear();
    const ToolMotions motions = tools.advance(strokes.at(time_s, plan.scene.styluses));
    obstacles.advance(static_cast<double>(t) / tick_hz, 1 / tick_hz);
    reference.step(motions, obstacles.motions());
    if (comparison) comparison->step(motions, obstacles.motions());
    keepWorst(reference, tick_hz, metrics.extremes);
    progress("simulating", static_cast<double>(t + 1) / static_cast<double>(plan.ticks));
  }
  metrics.wall_s = std::chrono::duration<double>(Clock::now() - start).count();
  metrics.springs_cut = reference.solver().springs_cut;
  metrics.substeps = plan.ticks * static_cast<uint64_t>(reference.substeps());
  metrics.dt_s = reference.dt_s();
  metrics.dt_safe_s = metrics.dt_limit_s = reference.dtSafe_s();
  metrics.simulated_s = static_cast<double>(plan.ticks) / tick_hz;
  metrics.state_hash = stateHash(model, reference.solver().state());
  for (const auto& process : reference.processes()) metrics.facts.push_back(process->facts());
  metrics.backend = "reference";
  metrics.stepped_by = "reference (float64), as set by `viscera bench reference`";
  metrics.renderer = "none";
  nlohmann::ordered_json out = cli::toJson(metrics);
  if (comparison) out["gpu_error"] = comparison->error(reference.solver());
  std::cout << out.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace) << std::endl;
  return 0;
}

}  // namespace viscera::bench
