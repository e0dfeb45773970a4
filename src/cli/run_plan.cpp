// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/run_plan.h"

#include <cmath>
#include <string>

#include "cli/scene_lookup.h"
#include "viscera/math/error.h"

namespace viscera::cli {

namespace {

void requireStyluses(const Strokes& strokes, const Scene& scene, const std::string& file) {
  for (const Stroke& stroke : strokes.strokes) {
    bool known = false;
    std::string names;
    for (const StylusConfig& stylus : scene.styluses) {
      known |= stylus.name == stroke.stylus;
      names += (names.empty() ? "" : ", ") + stylus.name;
    }
    if (!known)
      throw StrokesError(file + ": stylus '" + stroke.stylus + "' does not exist in the scene; it has " +
                         (names.empty() ? "no styluses" : names));
  }
}

}  // namespace

RunPlan planRun(const RunOptions& options) {
  if (options.seconds && std::isnan(*options.seconds))  // CLI::Range accepts NaN
    throw Error("--seconds must be a number, 0 .. 86400; found nan");
  RunPlan plan{sceneOf(options).scene, {}, 0};
  if (!options.strokes.empty()) {
    plan.strokes = loadStrokes(options.strokes);
    requireStyluses(plan.strokes, plan.scene, options.strokes);
    plan.strokes.requireTickRate(plan.scene.solver.tick_hz);
  }
  const double seconds = options.seconds.value_or(options.strokes.empty() ? 1.0 : plan.strokes.duration_s());
  plan.ticks = static_cast<uint64_t>(std::llround(seconds * plan.scene.solver.tick_hz));
  return plan;
}

std::unique_ptr<gpu::Context> contextFor(bool no_view, const Scene& scene) {
  if (no_view && scene.solver.backend != Backend::kGpu) return nullptr;
  try {
    return std::make_unique<gpu::Context>(scene.solver.device);
  } catch (const GpuError& error) {
    const char* const remedy = no_view ? "; solver.backend: cpu or auto works without OpenGL, on the CPU"
                                       : "; --no-view works without OpenGL, on the CPU and without pictures";
    throw GpuError(error.what() + std::string(remedy));
  }
}

void writeTools(const ToolRows& tools, const std::string& folder) {
  tools.write(folder + "/tools.csv");
  tools.writeJigsaws(folder + "/kinematics.txt");
}

}  // namespace viscera::cli
