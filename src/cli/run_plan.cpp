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
      throw StrokesError(file + ": stylus '" + stroke.stylus +
                         "' is not one of the scene's: " + (names.empty() ? "it has none" : names));
  }
}

}  // namespace

RunPlan planRun(const RunOptions& options) {
  if (options.seconds && std::isnan(*options.seconds))  // passes CLI::Range
    throw Error("--seconds is a number, 0 .. 86400; found nan");
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
    const char* const way_out = no_view ? "; solver.backend: cpu or auto does without, on the processor"
                                        : "; --no-view does without, on the processor and without pictures";
    throw GpuError(error.what() + std::string(way_out));
  }
}

void writeHands(const HandRows& hands, const std::string& folder) {
  hands.write(folder + "/hands.csv");
  hands.writeJigsaws(folder + "/kinematics.txt");
}

}  // namespace viscera::cli
