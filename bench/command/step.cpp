// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/command/step.h"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iostream>
#include <thread>

#include "bench/command/stages.h"
#include "cli/scene_lookup.h"
#include "solver/gpu/gpu_solver.h"
#include "viscera/gpu/context.h"
#include "viscera/math/error.h"
#include "viscera/math/state_hash.h"

namespace viscera::bench {

namespace {

constexpr int kWarmUpTicks = 2;
constexpr int kTicks = 24;
constexpr int kSubstepsPerTick = 20;  // a rate like that of a live session: one measurement pass in 20 substeps

struct Row {
  std::string scene;
  size_t nodes = 0;
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
  FixedConfig top;
  top.shape = FixedShape::kPlane;
  top.point_m = Vector3d(0, 0, 0.04);
  top.normal = -Vector3d::UnitZ();
  body.fixed.push_back(top);
  scene.bodies.push_back(body);
  return scene;
}

/// The tick is made as long as the wanted number of substeps.
void fitTick(const Model& model, Scene& scene) {
  scene.solver.measured_limit = false;
  scene.solver.tick_hz = 1.0 / (kSubstepsPerTick * scene.solver.dt_fraction * safeTimeStep(model)) * (1 + 1e-9);
}

Row measure(Scene scene) {
  const Model model = buildModel(scene, cli::consoleProgress());
  fitTick(model, scene);
  GpuSolver solver(model, scene);
  std::vector<double> ms;
  layout::TickStats stats;
  for (int t = 0; t < kWarmUpTicks + kTicks; ++t) {
    const auto start = std::chrono::steady_clock::now();
    solver.step({});
    while (solver.pollStats(stats, true)) {
    }
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    if (t >= kWarmUpTicks) ms.push_back(took.count() / solver.substeps());
  }
  std::sort(ms.begin(), ms.end());
  const size_t p99 = std::min(ms.size() - 1, static_cast<size_t>(0.99 * static_cast<double>(ms.size())));
  return {scene.name, model.activeNodes(), ms[ms.size() / 2], ms[p99],
          StateHash::text(stateHash(model, solver.readState()))};
}

std::string quoted(const std::string& text) {
  return text.find(',') == std::string::npos ? text : '"' + text + '"';
}

void print(std::ostream& out, const Row& row, const gpu::Context& context) {
  out << row.scene << ',' << row.nodes << ",gpu," << std::thread::hardware_concurrency() << ','
      << quoted(context.renderer()) << ',' << row.median_ms << ',' << row.p99_ms << ','
      << static_cast<double>(row.nodes) / (row.median_ms * 1e-3) << ',' << row.hash << std::endl;
}

void stagesOf(const std::vector<Scene>& scenes, std::ostream& out) {
  printStageNames(out);
  for (Scene scene : scenes) {
    const Model model = buildModel(scene, cli::consoleProgress());
    fitTick(model, scene);
    printStages(out, model, scene);
  }
}

}  // namespace

int step(const StepOptions& options) {
  std::vector<Scene> scenes;
  if (!options.scene.empty()) {
    scenes.push_back(loadScene(cli::findScene(options.scene), options.overrides));
  } else {
    for (int nodes : options.nodes.empty() ? std::vector<int>{10000, 42745, 100000} : options.nodes) {
      scenes.push_back(hangingScene(TissueSource::kBox, nodes));
      scenes.push_back(hangingScene(TissueSource::kPhantom, nodes));
    }
  }
  std::ofstream file;
  if (options.csv != "-") {
    file.open(options.csv);
    if (!file) throw Error(options.csv + ": cannot be written");
  }
  std::ostream& out = options.csv == "-" ? std::cout : file;
  gpu::Context context;
  if (options.stages) {
    stagesOf(scenes, out);
    return 0;
  }
  out << "scene,nodes,backend,threads,renderer,ms_per_step_median,ms_per_step_p99,node_updates_per_s,state_hash\n";
  for (const Scene& scene : scenes) print(out, measure(scene), context);
  return 0;
}

}  // namespace viscera::bench
