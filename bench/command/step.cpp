// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/command/step.h"

#include <fstream>
#include <iostream>

#include "bench/command/stages.h"
#include "bench/harness/machine/machine.h"
#include "bench/harness/specimens/backends.h"
#include "calibration/timed_ticks.h"
#include "cli/scene_lookup.h"
#include "math/processors.h"
#include "solver/cpu/cpu_solver.h"
#include "viscera/math/error.h"
#include "viscera/math/state_hash.h"

namespace viscera::bench {

namespace {

constexpr TimedTicks kTicks{24, 24, 0};
constexpr int kSubstepsPerTick = 20;  // a rate like that of a live session: one measurement pass in 20 substeps

struct Row {
  std::string scene;
  size_t nodes = 0;
  Backend backend = Backend::kGpu;
  int threads = 0;
  std::string renderer;
  double median_ms = 0, p99_ms = 0;
  std::string hash;
};

/// A body hanging from its top tenth, so that every spring works.
Scene hangingScene(TissueSource source, int nodes) {
  Scene scene;
  scene.name = source == TissueSource::kBox ? "cube" : "heart";
  BodyConfig body;
  body.source = source;
  body.box_size_m = Vector3d::Constant(0.1);
  body.target_nodes = nodes;
  scene.solver.sleep_speed_m_per_s = 0;  // what comes to rest is measured like what moves
  FixedConfig top;
  top.shape = FixedShape::kPlane;
  top.point_m = Vector3d(0, 0, 0.04);
  top.normal = -Vector3d::UnitZ();
  body.fixed.push_back(top);
  scene.bodies.push_back(body);
  return scene;
}

Row measure(const Model& model, const Scene& scene, Backend backend, const Machine& machine) {
  const std::unique_ptr<Ticks> solver = solverOn(backend, model, scene);
  if (backend == Backend::kGpu) {
    warmUpGpu([&] { stepAndWait(*solver, {}); });
    solver->reset();  // so that the same ticks are timed whatever the renderer
  }
  const std::vector<double> substep_s = substepTimes(
      *solver, [] { return ToolMotions(); }, kTicks);
  const int there = usableProcessors();
  Row row;
  row.scene = scene.name;
  row.nodes = model.activeNodes();
  row.backend = backend;
  row.threads = backend == Backend::kCpu && scene.solver.threads > 0 ? scene.solver.threads : there;
  row.renderer = backend == Backend::kCpu ? simdTargets().front() : machine.context->renderer();
  row.median_ms = 1e3 * median(substep_s);
  row.p99_ms = 1e3 * percentile(substep_s, 0.99);
  row.hash = StateHash::text(stateHash(model, solver->readState()));
  return row;
}

std::string quoted(const std::string& text) {
  return text.find(',') == std::string::npos ? text : '"' + text + '"';
}

void print(std::ostream& out, const Row& row) {
  out << row.scene << ',' << row.nodes << ',' << nameOf(row.backend) << ',' << row.threads << ','
      << quoted(row.renderer) << ',' << row.median_ms << ',' << row.p99_ms << ','
      << static_cast<double>(row.nodes) / (row.median_ms * 1e-3) << ',' << row.hash << std::endl;
}

void stagesOf(const std::vector<Scene>& scenes, std::ostream& out) {
  printStageNames(out);
  for (Scene scene : scenes) {
    const Model model = buildModel(scene, cli::consoleProgress());
    fitTick(scene.solver, model, kSubstepsPerTick);
    printStages(out, model, scene);
  }
}

void measureAll(const std::vector<Scene>& scenes, const Machine& machine, int threads, std::ostream& out) {
  out << "scene,nodes,backend,threads,renderer,ms_per_step_median,ms_per_step_p99,node_updates_per_s,state_hash\n";
  for (Scene scene : scenes) {
    const Model model = buildModel(scene, cli::consoleProgress());
    fitTick(scene.solver, model, kSubstepsPerTick);
    if (threads > 0) scene.solver.threads = threads;
    for (const Backend backend : machine.backends) print(out, measure(model, scene, backend, machine));
  }
}

}  // namespace

int step(const StepOptions& options) {
  std::vector<Scene> scenes;
  if (!options.scene.empty()) {
    scenes.push_back(loadScene(cli::findScene(options.scene), options.overrides));
  } else {
    const std::vector<int> sizes = options.nodes.empty() ? std::vector<int>{10000, 42745, 100000} : options.nodes;
    for (const TissueSource source : {TissueSource::kBox, TissueSource::kPhantom}) {
      for (const int nodes : sizes) scenes.push_back(hangingScene(source, nodes));
    }
  }
  std::ofstream file;
  if (options.csv != "-") {
    file.open(options.csv);
    if (!file) throw Error(options.csv + ": cannot be written");
  }
  std::ostream& out = options.csv == "-" ? std::cout : file;
  const Machine machine = machineFor(options.backend, options.device);
  if (options.stages) {
    stagesOf(scenes, out);
    return 0;
  }
  measureAll(scenes, machine, options.threads, out);
  return 0;
}

}  // namespace viscera::bench
