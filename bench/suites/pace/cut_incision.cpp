// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <chrono>
#include <cmath>
#include <string>

#include "bench/harness/rate.h"
#include "bench/harness/specimens/specimen.h"
#include "bench/suites/pace/cut_parts.h"
#include "solver/ticks/tissue_stepper.h"
#include "viscera/session/session.h"

namespace viscera::bench {

namespace {

constexpr double kSofter = 0.25;     // so that four substeps are a tick of 1 ms, the shortest possible
constexpr int kSubsteps = 4;         // per image, as in the paper
constexpr double kLongest_m = 0.08;  // length of the incision: from below the fixed top to the apex
constexpr double kDeep_m = 0.045;    // depth of the blade, from the front of the heart inwards
constexpr int kWidth_px = 640, kHeight_px = 480;
constexpr int kShorter = 4;     // a side of the short form's pictures is this times shorter
constexpr double kSlowest = 2;  // time of an image of a cut heart relative to an uncut one, with the blade away

Scene incisionScene(int nodes, int shorter, Backend backend) {
  Scene scene = pigHeartScene(nodes, 0.2);
  scene.cameras[0].width_px = kWidth_px / shorter;
  scene.cameras[0].height_px = kHeight_px / shorter;
  scene.solver.backend = backend;
  scene.solver.substeps = kSubsteps;
  scene.bodies[0].material.young_modulus_pa *= kSofter;
  scene.solver.dt_fraction = scene.solver.dt_fraction_strained = 0.5;
  scene.solver.tick_hz = std::min(1000.0, 1 / (kSubsteps * 0.5 * safeTimeStep(buildModel(scene))));
  scene.styluses.resize(1);
  scene.styluses[0].idle = ToolMode::kCut;
  scene.styluses[0].cut.blade_length_m = 2 * kDeep_m;
  scene.styluses[0].cut.blade_side = BladeSide::kAhead;
  return scene;
}

int shorterBy(const Report& report) {
  return report.isShort() ? kShorter : 1;
}

/// Returns a blade that points into the heart from its front, at a length of the incision.
StylusSamples bladeAt(double front_m, double length_m) {
  StylusSamples out;
  out[0].valid = true;
  out[0].pose.position_m = Vector3d(0.004, front_m - kDeep_m, 0.028 - length_m);
  out[0].pose.orientation = Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitX());  // -z of the stylus is +y
  out[0].received = std::chrono::steady_clock::now();
  return out;
}

uint64_t springsOf(const Session& session) {
  uint64_t count = 0;
  for (const layout::NodeBits& bits : session.solver().readState().nodes) {
    for (uint32_t spring = 0; spring < layout::kSpringsPerNode; spring += 2) count += springCount(bits, spring) ? 1 : 0;
  }
  return count;
}

/// Returns images per second, one after every tick, by the median time from a tick's start to its image.
template <class Samples>
double picturesPerSecond(Session& session, int ticks, Samples samples) {
  FrameRequest outputs;
  outputs.cameras = {true};
  std::vector<double> took_s;
  for (int t = 0; t < ticks; ++t) {
    const auto start = std::chrono::steady_clock::now();
    session.step(samples(t), outputs);
    session.drain();  // as in the paper: an image after every four substeps, without skipping
    took_s.push_back(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  return 1 / median(took_s);
}

void measureBackend(Report& report, gpu::Context& context, Backend backend, Table& table, Plot& plot) {
  report.stage("incision, " + nameOf(backend));
  Session session(incisionScene(report.isShort() ? 3000 : 42745, shorterBy(report), backend), context);
  const double front_m = farthestNode(session.model(), session.solver().readState(), -Vector3d::UnitY()).y();
  const int stages = report.isShort() ? 2 : 8, ticks = report.isShort() ? 4 : 16;
  const auto springs = static_cast<double>(springsOf(session));
  const auto away = [](int) { return StylusSamples{}; };
  picturesPerSecond(session, 3, away);  // warms up
  const double whole = picturesPerSecond(session, ticks, away);
  table.add({nameOf(backend), 0, 0, "", whole, 1});
  Series cutting{nameOf(backend) + ", cutting", {0}, {whole}}, after{nameOf(backend) + ", blade away", {0}, {whole}};
  double last = whole;
  for (int stage = 1; stage <= stages; ++stage) {
    const double from_m = kLongest_m * (stage - 1) / stages, step_m = kLongest_m / stages / ticks;
    const double during =
        picturesPerSecond(session, ticks, [&](int t) { return bladeAt(front_m, from_m + step_m * (t + 1)); });
    last = picturesPerSecond(session, ticks, away);
    const double cut = 100 * (1 - static_cast<double>(springsOf(session)) / springs);
    table.add({nameOf(backend), 1e3 * (from_m + step_m * ticks), cut, during, last, last / whole});
    cutting.x.push_back(cut);
    cutting.y.push_back(during);
    after.x.push_back(cut);
    after.y.push_back(last);
  }
  plot.series.push_back(cutting);
  plot.series.push_back(after);
  if (!report.isShort())
    report.checkAtMost("time of a picture with the longest incision over one of the whole heart, " + nameOf(backend),
                       whole / last, kSlowest);
}

}  // namespace

void measureIncision(Report& report, gpu::Context& context) {
  const auto pixels = [&](int side) { return std::to_string(side / shorterBy(report)); };
  Table table("pictures (" + pixels(kWidth_px) + " x " + pixels(kHeight_px) +
                  ") per second by length of an incision, four substeps per picture, none skipped",
              {{"backend"},
               {"incision", "mm", 3},
               {"springs cut", "%", 3},
               {"cutting", "pictures/s", 3},
               {"blade away", "pictures/s", 3},
               {"over whole", "", 3}});
  Plot plot{"Pictures per second by size of the incision", "springs cut [%]", "pictures/s", false, false, {}};
  for (const Backend backend : {Backend::kCpu, Backend::kGpu}) measureBackend(report, context, backend, table, plot);
  report.add(table, "incision");
  report.add(plot, "incision");
}

}  // namespace viscera::bench
