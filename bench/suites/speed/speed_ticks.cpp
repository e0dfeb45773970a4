// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/machine/machine.h"
#include "bench/harness/specimens/backends.h"
#include "bench/harness/specimens/clamp.h"
#include "bench/suites/speed/speed_parts.h"
#include "calibration/timed_ticks.h"
#include "cli/scene_lookup.h"
#include "math/processors.h"
#include "solver/cpu/cpu_solver.h"
#include "viscera/gpu/context.h"
#include "viscera/math/state_hash.h"

namespace viscera::bench {

namespace {

constexpr TimedTicks kTicks{24, 24, 0};

/// Returns a body that hangs from its top tenth, so that every spring has a force.
Scene hangingScene(TissueSource source, int nodes) {
  Scene scene;
  scene.name = source == TissueSource::kBox ? "cube" : "heart";
  BodyConfig body;
  body.source = source;
  body.box_size_m = Vector3d::Constant(0.1);
  body.target_nodes = nodes;
  scene.solver.sleep_speed_m_per_s = 0;  // keeps tissue at rest awake, so that it is measured like moving tissue
  body.fixed.push_back(clampAbove(0.04));
  scene.bodies.push_back(body);
  return scene;
}

std::vector<Cell> measure(const Model& model, const Scene& scene, Backend backend, const Report& report) {
  const std::unique_ptr<TissueStepper> solver = solverOn(backend, model, scene);
  if (backend == Backend::kGpu) {
    warmUpGpu([&] { stepAndWait(*solver, {}); });
    solver->reset();  // so that the same ticks are timed on any renderer
  }
  const std::vector<double> substep_s = substepTimes(
      *solver, [] { return ToolMotions(); }, kTicks);
  const bool on_cpu = backend == Backend::kCpu;
  const int threads = on_cpu && scene.solver.threads > 0 ? scene.solver.threads : usableProcessors();
  const double median_s = median(substep_s), nodes = static_cast<double>(model.activeNodes());
  return {scene.name,
          nodes,
          nameOf(backend),
          threads,
          on_cpu ? simdTargets().front() : report.context()->renderer(),
          1e3 * median_s,
          1e3 * percentile(substep_s, 0.99),
          nodes / median_s,
          StateHash::text(stateHash(model, solver->readState()))};
}

}  // namespace

std::vector<Scene> tickScenes(const Report& report) {
  if (!report.scene().empty()) return {loadScene(cli::findScene(report.scene()), report.overrides())};
  std::vector<int> sizes = report.nodes();
  if (sizes.empty()) sizes = report.isShort() ? std::vector<int>{1000} : std::vector<int>{10000, 42745, 100000};
  std::vector<Scene> out;
  for (const TissueSource source : {TissueSource::kBox, TissueSource::kPhantom})
    for (const int nodes : sizes) out.push_back(hangingScene(source, nodes));
  return out;
}

void measureTicks(Report& report) {
  Table table("time of a substep, 20 in a tick", {{"scene"},
                                                  {"nodes", "", 8},
                                                  {"backend"},
                                                  {"threads"},
                                                  {"on"},
                                                  {"median", "ms"},
                                                  {"p99", "ms"},
                                                  {"updates", "node updates/s"},
                                                  {"state_hash"}});
  for (Scene scene : tickScenes(report)) {
    report.stage("ticks of " + scene.name);
    const Model model = buildModel(scene);
    fitTick(scene.solver, model, kSpecimenSubsteps);
    if (report.threads() > 0) scene.solver.threads = report.threads();
    for (const Backend backend : report.backends()) table.add(measure(model, scene, backend, report));
  }
  report.add(table, "ticks");
}

}  // namespace viscera::bench
