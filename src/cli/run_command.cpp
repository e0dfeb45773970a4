// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "cli/commands.h"
#include "cli/png_writer.h"
#include "cli/run_metrics.h"
#include "cli/run_plan.h"
#include "viscera/math/error.h"
#include "viscera/session/session.h"
#include "viscera/tools/strokes.h"

namespace viscera::cli {

namespace {

using Clock = std::chrono::steady_clock;
using Json = nlohmann::ordered_json;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Where pictures go: a numbered series per camera, and a named one for every mark of the strokes.
class Album {
 public:
  Album(const std::string& folder, const Scene& scene, const Strokes& strokes, uint64_t ticks)
      : folder_(folder), scene_(scene) {
    if (folder_.empty()) return;
    std::error_code error;
    std::filesystem::create_directories(folder_ + "/frames", error);
    if (error) throw Error(folder_ + ": cannot be made into a folder for pictures: " + error.message());
    for (const Mark& mark : strokes.marks) {
      const double tick = std::max(1.0, std::round(mark.time_s * scene.solver.tick_hz));
      if (tick > static_cast<double>(ticks)) {
        std::cout << "mark '" << mark.name << "' lies after the end: no picture\n";
        continue;
      }
      marks_.emplace(static_cast<uint64_t>(tick), mark.name);
    }
  }

  Wants wants(const Session& session) const {
    Wants out;
    if (folder_.empty()) return out;
    out.every_image = true;
    for (size_t c = 0; c < scene_.cameras.size(); ++c) {
      out.cameras.push_back(session.imageDue(c) || marks_.count(session.tick() + 1) > 0);
    }
    return out;
  }

  void add(const Frame& frame) const {
    for (const ImageFrame& image : frame.images) {
      char number[32];
      std::snprintf(number, sizeof number, "_%06llu.png", static_cast<unsigned long long>(image.tick));
      const std::string& camera = scene_.cameras[image.camera].name;
      writePng(folder_ + "/frames/" + camera + number, image.width, image.height, image.rgb);
      const auto named = marks_.equal_range(image.tick);
      for (auto mark = named.first; mark != named.second; ++mark) {
        writePng(folder_ + "/" + mark->second + "_" + camera + ".png", image.width, image.height, image.rgb);
      }
    }
  }

 private:
  std::string folder_;
  const Scene& scene_;
  std::multimap<uint64_t, std::string> marks_;  ///< tick -> names
};

Json metricsOf(const Session& session, const layout::TickStats& stats, const std::string& renderer, double wall_s) {
  const Counters counters = session.counters();
  RunMetrics metrics{session.scene().name, session.model()};
  metrics.springs_cut = stats.springs_cut;
  metrics.substeps = counters.substeps;
  metrics.dt_s = session.solver().dt_s();
  metrics.dt_safe_s = session.solver().dtSafe_s();
  metrics.simulated_s = static_cast<double>(counters.ticks) * session.tick_s();
  metrics.wall_s = wall_s;
  metrics.state_hash = session.stateHash();
  metrics.extremes = session.extremes();
  metrics.images = counters.renders;
  metrics.backend = session.solver().backend();
  metrics.renderer = renderer;
  return toJson(metrics);
}

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
  Overrides overrides = meshOverrides(options.mesh);
  overrides.insert(overrides.end(), options.overrides.begin(), options.overrides.end());
  RunPlan plan{loadScene(findScene(options.scene), overrides), {}, 0};
  if (!options.strokes.empty()) {
    plan.strokes = loadStrokes(options.strokes);
    requireStyluses(plan.strokes, plan.scene, options.strokes);
  }
  const double seconds = options.seconds.value_or(options.strokes.empty() ? 1.0 : plan.strokes.duration_s());
  plan.ticks = static_cast<uint64_t>(std::llround(seconds * plan.scene.solver.tick_hz));
  return plan;
}

int run(const RunOptions& options) {
  if (options.reference && !options.out.empty()) {
    throw Error("--out goes without --reference: pictures come from the GPU, which the reference does not use");
  }
  RunPlan plan = planRun(options);
  if (options.reference) return runReference(plan, options.compare);
  const uint64_t ticks = plan.ticks;
  const Scene& scene = plan.scene;
  Strokes& strokes = plan.strokes;

  gpu::Context context(scene.solver.device);
  const Progress progress = consoleProgress();
  Session session(scene, context, progress);
  resolveAnchors(strokes, session.model());
  for (const Body& body : session.model().bodies) {
    for (const std::string& note : body.notes) std::cout << body.name << ": " << note << '\n';
  }
  const Album album(options.out, session.scene(), strokes, ticks);
  const Clock::time_point start = Clock::now();
  for (uint64_t t = 0; t < ticks; ++t) {
    const double time_s = static_cast<double>(t + 1) * session.tick_s();
    album.add(session.step(strokes.at(time_s, scene.styluses), album.wants(session)));
    progress("simulating", static_cast<double>(t + 1) / static_cast<double>(ticks));
  }
  const Frame last = session.drain();
  const double wall_s = secondsSince(start);
  album.add(last);

  const Json metrics = metricsOf(session, last.stats, context.renderer(), wall_s);
  if (!options.out.empty()) {
    std::ofstream file(options.out + "/metrics.json");
    file << metrics.dump(2) << '\n';
    if (!file) throw Error(options.out + "/metrics.json: cannot be written");
  }
  std::cout << metrics.dump() << std::endl;
  return 0;
}

}  // namespace viscera::cli
