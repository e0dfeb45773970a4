// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/png_writer.h"
#include "viscera/math/error.h"
#include "viscera/math/state_hash.h"
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
  const Extremes& extremes = session.extremes();
  const double simulated_s = static_cast<double>(counters.ticks) * session.tick_s();
  const size_t nodes = session.model().activeNodes();
  Json out;
  out["scene"] = session.scene().name;
  out["nodes"] = nodes;
  out["springs"] = session.model().springs();
  out["springs_cut"] = stats.springs_cut;
  out["faces"] = session.model().skinTriangles();
  out["steps"] = counters.substeps;
  out["dt_s"] = session.solver().dt_s();
  out["dt_safe_s"] = session.solver().dtSafe_s();
  out["simulated_s"] = simulated_s;
  out["wall_s"] = wall_s;
  out["real_time_factor"] = simulated_s / wall_s;
  out["node_updates_per_s"] = static_cast<double>(nodes) * static_cast<double>(counters.substeps) / wall_s;
  out["state_hash"] = StateHash::text(session.stateHash());
  out["max_stretch"] = extremes.max_stretch;
  out["max_speed_m_per_s"] = extremes.max_speed_m_per_s;
  out["nonfinite"] = extremes.nonfinite;
  out["peak_force_n"] = extremes.peak_force_n;
  out["images"] = counters.renders;
  out["backend"] = session.solver().backend();
  out["renderer"] = renderer;
  return out;
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

int run(const RunOptions& options) {
  Overrides overrides = meshOverrides(options.mesh);
  overrides.insert(overrides.end(), options.overrides.begin(), options.overrides.end());
  const Scene scene = loadScene(findScene(options.scene), overrides);
  Strokes strokes;
  if (!options.strokes.empty()) {
    strokes = loadStrokes(options.strokes);
    requireStyluses(strokes, scene, options.strokes);
  }
  const double seconds = options.seconds.value_or(options.strokes.empty() ? 1.0 : strokes.duration_s());

  gpu::Context context(scene.solver.device);
  const Progress progress = consoleProgress();
  Session session(scene, context, progress);
  resolveAnchors(strokes, session.model());
  for (const Body& body : session.model().bodies) {
    for (const std::string& note : body.notes) std::cout << body.name << ": " << note << '\n';
  }
  const uint64_t ticks = static_cast<uint64_t>(std::llround(seconds * scene.solver.tick_hz));
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
