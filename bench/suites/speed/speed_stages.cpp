// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/machine/machine.h"
#include "bench/suites/speed/speed_parts.h"
#include "calibration/timed_ticks.h"
#include "gpu/stage_clock.h"
#include "session/inline_view.h"
#include "solver/gpu/gpu_solver.h"
#include "viscera/model/scene/scene.h"

namespace viscera::bench {

namespace {

constexpr int kStageTicks = 24;

/// Returns the centre of the first body's side at +x, where a probe touches the cube.
Vector3d sideOf(const Body& body) {
  Vector3d lowest = Vector3d::Constant(1e9), highest = -lowest;
  for (uint32_t slot : body.lattice.active_slots) {
    lowest = lowest.cwiseMin(body.lattice.restPosition(slot));
    highest = highest.cwiseMax(body.lattice.restPosition(slot));
  }
  Vector3d side = 0.5 * (lowest + highest);
  side.x() = highest.x();
  return side;
}

/// Returns a probe that rests against the body and a blade that cuts air, which costs the same as cutting.
ToolMotions probeAndBlade(const Model& model) {
  ToolMotions motions;
  for (StylusMotion& motion : motions) {
    motion.present = true;
    motion.from.position_m = motion.to.position_m = sideOf(model.bodies[0]);
  }
  motions[0].mode = ToolMode::kProbe;
  motions[1].mode = ToolMode::kCut;
  motions[1].from.position_m.x() += 1;
  motions[1].to.position_m.x() += 1;
  return motions;
}

/// Steps the scene on the GPU with a probe and a blade, maps its surface mesh and draws it.
void addStages(Table& table, const Model& model, Scene scene) {
  scene.styluses.resize(layout::kMaxStyluses);
  if (scene.cameras.empty()) scene.cameras.emplace_back();
  GpuSolver solver(model, scene);
  InlineView view(model, scene);
  RenderRequest request;
  request.motions = probeAndBlade(model);
  request.outputs.surface = request.outputs.every_image = true;
  request.outputs.cameras.assign(scene.cameras.size(), false);
  request.outputs.cameras[0] = true;
  const auto tick = [&] {
    Pictures pictures;
    layout::TickStats stats;
    solver.step(request.motions);
    view.capture(solver.state(), request, pictures);
    view.collect(pictures, true);
    solver.pollStats(stats, true);
  };
  warmUpGpu(tick);
  gpu::StageClock clock;
  for (int t = 0; t < kStageTicks; ++t) tick();
  const auto& times = clock.collect(true);
  const double updates = static_cast<double>(model.activeNodes()) * solver.substeps();  // per tick
  for (size_t s = 0; s < gpu::kStages; ++s) {
    if (times[s].count == 0) continue;
    const double per_tick_s = times[s].seconds / kStageTicks;
    table.add({scene.name, static_cast<double>(model.activeNodes()), gpu::stageName(static_cast<gpu::Stage>(s)),
               static_cast<double>(times[s].count) / kStageTicks, 1e3 * per_tick_s, 1e9 * per_tick_s / updates});
  }
}

}  // namespace

void measureTickStages(Report& report) {
  Table table(
      "stages of a tick by the GPU's own clock",
      {{"scene"}, {"nodes", "", 8}, {"stage"}, {"times per tick"}, {"per tick", "ms"}, {"per node update", "ns"}});
  for (Scene scene : tickScenes(report)) {
    report.stage("stages of " + scene.name);
    const Model model = buildModel(scene);
    fitTick(scene.solver, model, kSpecimenSubsteps);
    addStages(table, model, scene);
  }
  report.add(table, "stages");
}

}  // namespace viscera::bench
