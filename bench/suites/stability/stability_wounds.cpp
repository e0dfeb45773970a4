// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <chrono>
#include <memory>
#include <vector>

#include "bench/harness/rate.h"
#include "bench/harness/specimens/clamp.h"
#include "bench/suites/stability/stability_suite.h"
#include "viscera/session/session.h"

namespace viscera::bench {

namespace {

constexpr double kStabilityWoundsSpacing_m = 0.004;
constexpr double kSofter = 0.005;  // relative to E: a tick is a few substeps, and waves still travel a spacing in it
constexpr double kDearer = 2;      // cost of the last hundred cuts relative to the first hundred
constexpr size_t kSome = 100;
constexpr double kOffset = 0.25;  // distance of a line from the nodes [spacings]

/// A box in which a short blade cuts parallel lines, in levels one below the other.
struct Block {
  Vector3i cells;
  Vector3d size_m() const { return kStabilityWoundsSpacing_m * cells.cast<double>(); }
  int lines() const { return cells.x() - 2; }
  int levels() const { return cells.z() / 2 - 1; }
  int positions() const { return cells.y() + 2; }  ///< positions of a line: from before the box until behind it
};

Scene sceneOf(const Block& block, Backend backend) {
  Scene scene;
  BodyConfig body;
  body.source = TissueSource::kBox;
  body.box_size_m = block.size_m();
  body.spacing_m = kStabilityWoundsSpacing_m;
  body.material.young_modulus_pa *= kSofter;
  body.fixed.push_back(
      clampBehind(Vector3d(0, 0, -block.size_m().z() / 2 + 0.1 * kStabilityWoundsSpacing_m), Vector3d::UnitZ()));
  scene.bodies.push_back(body);
  scene.environment.gravity_m_per_s2 = Vector3d::Zero();
  scene.solver.backend = backend;
  StylusConfig stylus;
  stylus.idle = ToolMode::kCut;
  stylus.cut.blade_length_m = 2 * kStabilityWoundsSpacing_m;
  stylus.cut.blade_side = BladeSide::kAhead;
  scene.styluses = {stylus};
  return scene;
}

/// Returns the blade's pose at a tick; between two lines it is away.
StylusSamples bladeAt(const Block& block, size_t tick) {
  const auto positions = static_cast<size_t>(block.positions()), lines = static_cast<size_t>(block.lines());
  const size_t line = tick / (positions + 1), position = tick % (positions + 1);
  StylusSamples out;
  out[0].valid = position > 0;
  const Vector3d along(static_cast<double>(line % lines) + 1 + kOffset, static_cast<double>(position) - 1.5 + kOffset,
                       static_cast<double>(block.cells.z()) - 2 * static_cast<double>(line / lines) - 1 - kOffset);
  out[0].pose.position_m = kStabilityWoundsSpacing_m * along - block.size_m() / 2;
  return out;
}

struct Costs {
  std::vector<double> tick_s, picture_s;  ///< [cuts] times of ticks that have cut
  double springs = 0, triangles = 0;

  /// Returns the time of a tick and its surface, the median of several from `first` on.
  double at(size_t first) const {
    std::vector<double> sums;
    for (size_t i = first; i < first + kSome; ++i) sums.push_back(tick_s[i] + picture_s[i]);
    return median(sums);
  }
};

double since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

Costs cutOn(Report& report, Backend backend, const Block& block, size_t cuts) {
  gpu::Context* context = backend == Backend::kGpu ? report.context() : nullptr;
  const Scene scene = sceneOf(block, backend);
  const std::unique_ptr<Session> session =
      context ? std::make_unique<Session>(scene, *context) : std::make_unique<Session>(scene);
  FrameRequest outputs;
  outputs.surface = true;
  Costs out;
  const auto ticks = static_cast<size_t>(block.lines() * block.levels() * (block.positions() + 1));
  for (size_t tick = 0; tick < ticks && out.tick_s.size() < cuts; ++tick) {
    if (tick % 1000 == 0) report.stage("cuts with their wounds, tick " + std::to_string(tick) + ", " + nameOf(backend));
    const auto start = std::chrono::steady_clock::now();
    session->step(bladeAt(block, tick), {});
    const double springs = session->drain().stats.springs_cut, tick_s = since(start);
    const auto shown = std::chrono::steady_clock::now();
    const Pictures pictures = session->show(outputs);
    if (springs <= out.springs) continue;
    out.springs = springs;
    out.tick_s.push_back(tick_s);
    out.picture_s.push_back(since(shown));
    if (pictures.surface) out.triangles = static_cast<double>(pictures.surface->topology->triangleCount());
  }
  return out;
}

double medianOf(const std::vector<double>& values, size_t first) {
  return median(
      {values.begin() + static_cast<ptrdiff_t>(first), values.begin() + static_cast<ptrdiff_t>(first + kSome)});
}

}  // namespace

void woundsOfStability(Report& report) {
  const Block block{report.isShort() ? Vector3i(12, 16, 8) : Vector3i(42, 60, 20)};
  const size_t cuts = report.isShort() ? 400 : 10000;
  Table table("a session of small cuts, a surface after each", {{"backend"},
                                                                {"cuts"},
                                                                {"springs cut"},
                                                                {"triangles"},
                                                                {"tick, first 100", "ms", 3},
                                                                {"tick, last 100", "ms", 3},
                                                                {"surface, first 100", "ms", 3},
                                                                {"surface, last 100", "ms", 3},
                                                                {"both, last over first", "", 3}});
  for (Backend backend : report.backends()) {
    const Costs costs = cutOn(report, backend, block, cuts);
    const std::string name = nameOf(backend) + ": wounds: ";
    report.checkAtMost(name + "cuts that were not made", static_cast<double>(cuts - costs.tick_s.size()), 0);
    if (costs.tick_s.size() < 2 * kSome) continue;
    const size_t last = costs.tick_s.size() - kSome;
    const double dearer = costs.at(last) / costs.at(0);
    table.add({nameOf(backend), static_cast<double>(costs.tick_s.size()), costs.springs, costs.triangles,
               1e3 * medianOf(costs.tick_s, 0), 1e3 * medianOf(costs.tick_s, last), 1e3 * medianOf(costs.picture_s, 0),
               1e3 * medianOf(costs.picture_s, last), dearer});
    if (!report.isShort()) report.checkAtMost(name + "cost of the last hundred cuts over the first", dearer, kDearer);
  }
  report.add(table, "wounds");
}

}  // namespace viscera::bench
