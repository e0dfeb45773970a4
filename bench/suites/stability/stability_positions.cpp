// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// The same tissue in other positions and sizes: far from the origin with tools and surface mesh, and with sizes of a
// millimetre, a centimetre and a metre.
#include <algorithm>
#include <cmath>
#include <limits>

#include "bench/harness/experiment.h"
#include "bench/harness/specimens/clamp.h"
#include "bench/suites/stability/stability_suite.h"
#include "viscera/session/session.h"

namespace viscera::bench {

namespace {

constexpr double kStabilityPositionsSpacing_m = 0.005, kAway_m = 1000;
/// Based on float32 resolution at 1000 m, 6e-5 m, in which tools and surface meshes are published: one rounding of the
/// vertex, and 1.7 times that of the tip, because squeezed cells expand sideways.
constexpr double kSkinApart_m = 1.6e-4;
constexpr double kForceApart = 0.03;   ///< relative to the reaction: the tip of a press of 6 mm has the same rounding
constexpr double kTissueApart = 0.03;  ///< relative to the largest displacement: likewise
constexpr double kSizesApart = 1e-4;   ///< relative to the largest displacement: float32, over a few thousand substeps

/// A box on the floor, pressed from above, in a session with its surface mesh.
struct Pressed {
  Field u_m;
  std::vector<float> skin_m;  ///< [3 * vertices]
  double force_n = 0;
};

Pressed press(Backend backend, gpu::Context* context, const Vector3d& position_m) {
  constexpr int kTicks = 40;
  Scene scene;
  BodyConfig body;
  body.source = TissueSource::kBox;
  body.box_size_m = Vector3d(0.03, 0.03, 0.02);
  body.spacing_m = kStabilityPositionsSpacing_m;
  body.position_m = position_m;
  body.fixed.push_back(clampBehind(position_m - Vector3d(0, 0, 0.0099), Vector3d::UnitZ()));
  scene.bodies.push_back(body);
  scene.environment.gravity_m_per_s2 = Vector3d::Zero();
  scene.solver.backend = backend;
  StylusConfig stylus;
  stylus.probe.radius_m = 0.008;
  scene.styluses = {stylus};
  const std::unique_ptr<Session> session =
      context ? std::make_unique<Session>(scene, *context) : std::make_unique<Session>(scene);
  StylusSamples samples;
  samples[0].valid = true;
  Pressed out;
  for (int t = 0; t < kTicks; ++t) {
    const double down = std::min(1.0, t / 20.0);
    samples[0].pose.position_m = position_m + Vector3d(0.001, 0.002, 0.01 + 0.008 + 0.002 - 0.006 * down);
    out.force_n = session->step(samples, {}).reactions[0].force_n.norm();
  }
  out.force_n = session->drain().reactions[0].force_n.norm();
  const HostState state = session->solver().readState();
  for (const layout::vec4& u : state.displacement_m) out.u_m.push_back(xyz(u));
  FrameRequest outputs;
  outputs.surface = true;
  const Pictures pictures = session->show(outputs);
  if (pictures.surface) out.skin_m = pictures.surface->positions_m;
  return out;
}

/// Returns the largest distance of a vertex to the nearest one of the surface mesh that is displaced by `position_m`
/// [m]; NaN if one of them is empty. Vertices do not correspond one to one: far away, rounding makes some edges exceed
/// the limit, and they are divided.
double skinsApart(const Pressed& here, const Pressed& there, const Vector3d& position_m) {
  if (here.skin_m.empty() || there.skin_m.empty()) return std::nan("");
  const auto at = [](const std::vector<float>& skin_m, size_t v) {
    return Vector3d(skin_m[3 * v], skin_m[3 * v + 1], skin_m[3 * v + 2]);
  };
  double out = 0;
  for (size_t v = 0; 3 * v < here.skin_m.size(); ++v) {
    const Vector3d moved = at(here.skin_m, v) + position_m;
    double nearest = std::numeric_limits<double>::infinity();
    for (size_t w = 0; 3 * w < there.skin_m.size(); ++w) {
      nearest = std::min(nearest, (at(there.skin_m, w) - moved).norm());
    }
    out = worse(out, nearest);
  }
  return out;
}

void measureFar(Report& report) {
  Table table("A box pressed by a probe 1000 m from the origin, against the same at the origin",
              {{"backend"},
               {"reaction", "N"},
               {"reaction apart", "1"},
               {"tissue apart", "1"},
               {"skin apart", "m"},
               {"vertices here"},
               {"there"}});
  for (Backend backend : report.backends()) {
    report.stage("far away, " + nameOf(backend));
    gpu::Context* context = backend == Backend::kGpu ? report.context() : nullptr;
    const Vector3d position_m(kAway_m, 0, 0);
    const Pressed here = press(backend, context, Vector3d::Zero()), there = press(backend, context, position_m);
    double apart = 0;
    for (size_t i = 0; i < here.u_m.size(); ++i) apart = worse(apart, (here.u_m[i] - there.u_m[i]).norm());
    apart /= largestNorm(here.u_m);
    const double force = std::abs(there.force_n / here.force_n - 1), skin_m = skinsApart(here, there, position_m);
    table.add({nameOf(backend), here.force_n, force, apart, skin_m, static_cast<double>(here.skin_m.size() / 3),
               static_cast<double>(there.skin_m.size() / 3)});
    const std::string name = nameOf(backend) + ": 1000 m from the origin: ";
    report.checkAtMost(name + "reaction apart", force, kForceApart);
    report.checkAtMost(name + "displacements apart", apart, kTissueApart);
    report.checkAtMost(name + "skin apart [m]", skin_m, kSkinApart_m);
  }
  report.add(table, "far");
}

/// Returns the displacements of a block that hangs and oscillates, over its size. Sizes are similar if E is
/// proportional to the size and time to its root: then weight over stiffness and drag over frequency are the same.
Field swing(Backend backend, double size_m, int ticks) {
  constexpr int kCells = 4;
  const double time = std::sqrt(size_m / 0.02);
  MaterialConfig material;
  material.young_modulus_pa *= size_m / 0.02;
  material.mass_damping_per_s /= time;
  const Model model = blockModel({kCells, kCells, kCells}, size_m / kCells, material,
                                 [](const Vector3i& n) { return n.z() == kCells; });
  Scene scene;
  scene.environment.gravity_m_per_s2 = Vector3d(3, 2, -9.81);
  scene.solver.tick_hz = 60 / time;
  scene.solver.sleep_distance_m = 100 * size_m;
  scene.solver.sleep_speed_m_per_s = 0;
  const std::unique_ptr<TissueStepper> solver = solverOn(backend, model, scene);
  for (int t = 0; t < ticks; ++t) solver->step({});
  Field out;
  for (const layout::vec4& u : solver->readState().displacement_m) out.push_back(xyz(u) / size_m);
  return out;
}

void measureSizes(Report& report) {
  Table table(
      "The same block in sizes of a millimetre, a centimetre and a metre, E in proportion: displacement over size",
      {{"backend"}, {"size", "m"}, {"largest", "", 7}, {"apart from 2 cm", "1"}});
  for (Backend backend : report.backends()) {
    report.stage("sizes, " + nameOf(backend));
    const int ticks = report.isShort() ? 10 : 60;
    const Field middle = swing(backend, 0.02, ticks);
    double worst = 0;
    for (double size_m : {0.002, 0.02, 2.0}) {
      const Field found = swing(backend, size_m, ticks);
      double apart = 0;
      for (size_t i = 0; i < found.size(); ++i) apart = worse(apart, (found[i] - middle[i]).norm());
      apart /= largestNorm(middle);
      table.add({nameOf(backend), size_m, largestNorm(found), apart});
      worst = worse(worst, apart);
    }
    report.checkAtMost(nameOf(backend) + ": sizes: displacement over size, apart", worst, kSizesApart);
  }
  report.add(table, "sizes");
}

}  // namespace

void positionsOfStability(Report& report) {
  measureFar(report);
  measureSizes(report);
}

}  // namespace viscera::bench
