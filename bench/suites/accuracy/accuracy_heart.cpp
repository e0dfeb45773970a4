// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "bench/harness/specimens/beam.h"
#include "bench/harness/specimens/clamp.h"
#include "bench/harness/work_precision.h"
#include "bench/suites/accuracy/accuracy_parts.h"
#include "viscera/tools/tools.h"

namespace viscera::bench {

namespace {

constexpr double kTick_hz = 60;
constexpr double kProbeRadius_m = 0.012;
constexpr double kGrabRadius = 1.57;  ///< [spacings]: includes all neighbours of a node, and none close to its boundary
constexpr double kPress_m = 0.006;    ///< depth of the probe [m]
constexpr double kPull_m = 0.01;

constexpr double kAccuracyHeartLeapfrogLimit =
    1e-2;  ///< for the longest substep; contact begins and ends between substeps

/// Phases: press from tick 0, hold, withdraw; grab, pull, release; the rest is free.
constexpr int kPressed = 8, kWithdraw = 12, kWithdrawn = 16, kGrab = 18, kPulled = 28, kLetGo = 30,
              kAccuracyHeartTicks = 40;

Scene heartScene(bool short_form) {
  BodyConfig heart;
  heart.source = TissueSource::kPhantom;
  heart.spacing_m = short_form ? 0.01 : 0.008;
  heart.skin = SkinSource::kVolume;
  heart.material.stiffness_damping_ratio = 0;  // verlet_paper does not support dashpots
  heart.material.law = Law::kSprings;          // the law that all integrators support
  heart.fixed.push_back(clampAbove(0.03));
  StylusConfig probe, grab;
  probe.probe.radius_m = kProbeRadius_m;
  grab.idle = ToolMode::kNone;
  grab.grab.radius_m = kGrabRadius * heart.spacing_m;
  Scene scene;
  scene.bodies.push_back(heart);
  scene.styluses = {probe, grab};
  return scene;
}

/// Returns a smooth ramp from 0 at `begin` to 1 at `end`, with zero slope at both.
double ramp(int tick, int begin, int end) {
  const double s = std::clamp(static_cast<double>(tick - begin) / (end - begin), 0.0, 1.0);
  return s * s * (3 - 2 * s);
}

/// Returns the position of the node that is farthest along a direction [m].
Vector3d farthest(const Experiment& experiment, const Vector3d& direction) {
  const Lattice& lattice = experiment.model.bodies[0].lattice;
  Vector3d best = Vector3d::Zero();
  double reach = -1e9;
  for (uint32_t slot : lattice.active_slots) {
    const Vector3d at = lattice.restPosition(slot) + xyz(experiment.start.displacement_m[slot]);
    if (at.dot(direction) <= reach) continue;
    reach = at.dot(direction);
    best = at;
  }
  return best;
}

/// Returns the samples: the probe comes from the patient's left, the grab takes the apex.
StylusSamples samplesAt(int tick, const Vector3d& side, const Vector3d& apex) {
  StylusSamples out;
  const double gap_m = kPress_m;  // the probe starts and ends clear of the tissue
  const double in = ramp(tick, 0, kPressed) - ramp(tick, kWithdraw, kWithdrawn);
  out[0].valid = tick <= kWithdrawn;
  out[0].pose.position_m = side + (kProbeRadius_m + gap_m - in * (kPress_m + gap_m)) * Vector3d::UnitX();
  out[1].valid = true;
  out[1].button1 = tick >= kGrab && tick < kLetGo;
  out[1].pose.position_m = apex - kPull_m * ramp(tick, kGrab, kPulled) * Vector3d(0, 0.6, 0.8);
  return out;
}

Experiment abusedHeart(bool short_form) {
  Experiment out;
  out.scene = heartScene(short_form);
  out.scene.solver.stability_monitor = false;
  out.scene.solver.tick_hz = kTick_hz;
  out.scene.solver.sleep_distance_m = 1e6;
  out.model = buildModel(out.scene);
  out.dt_safe_s = safeTimeStep(out.model);
  out.start = stateOf(out.model, sag(out.model, out.scene.environment.gravity_m_per_s2));
  const Vector3d side = farthest(out, Vector3d::UnitX()), apex = farthest(out, -Vector3d::UnitZ());
  Tools tools(out.scene.styluses, {waveSpeed(out.model) / kTick_hz});
  tools.advance(samplesAt(0, side, apex));
  for (int t = 1; t <= kAccuracyHeartTicks; ++t) out.motions.push_back(tools.advance(samplesAt(t, side, apex)));
  return out;
}

int substepsFor(const Experiment& experiment, double dt_in_dt_safe) {
  return std::max(1, static_cast<int>(std::ceil(1 / (kTick_hz * dt_in_dt_safe * experiment.dt_safe_s))));
}

std::vector<Method> methods(const Experiment& experiment, bool short_form) {
  std::vector<Method> out;
  const auto explicit_dt = short_form ? std::vector<double>{0.75} : std::vector<double>{0.8, 0.5, 0.25, 0.125};
  const auto implicit_dt = short_form ? std::vector<double>{16} : std::vector<double>{32, 16, 8, 4, 2, 1};
  for (Integrator integrator : {Integrator::kLeapfrog, Integrator::kVerletPaper}) {
    for (double dt : explicit_dt) out.push_back({integrator, substepsFor(experiment, dt)});
  }
  for (int iterations : short_form ? std::vector<int>{5} : std::vector<int>{2, 5, 10, 20, 50}) {
    for (double dt : implicit_dt) {
      if (dt * 10 < iterations) continue;  // many iterations of short substeps are far more work than leapfrog
      const Method method{Integrator::kPd, substepsFor(experiment, dt), iterations};
      if (!out.empty() && out.back() == method) continue;
      out.push_back(method);
    }
  }
  return out;
}

}  // namespace

void measureHeartPrecision(Report& report) {
  report.stage("heart, truth in float64");
  const Experiment experiment = abusedHeart(report.isShort());
  const double divisor = report.isShort() ? 4 : 16;
  const int substeps = substepsFor(experiment, 1 / divisor);
  const Track truth = runReference(experiment, substeps);
  const double left = misfit(experiment.model, runReference(experiment, (substeps + 1) / 2), truth).rms;
  report.note("heart: " + std::to_string(experiment.model.activeNodes()) +
              " nodes, pressed, grabbed, pulled and released within " + Cell(experiment.duration_s()).text(3) +
              " s; truth: float64 leapfrog at dt_safe/" + Cell(divisor).text(2) +
              ", which differs from twice that substep by " + Cell(left).text(3) + " rms\n");
  const std::vector<std::vector<Misfit>> errors =
      drawWorkPrecision(report, experiment, truth, methods(experiment, report.isShort()), "heart",
                        "Heart, pressed, grabbed, pulled and released");
  for (size_t b = 0; b < errors.size(); ++b) {
    report.checkAtMost(nameOf(report.backends()[b]) + ": heart: rms error of leapfrog at its longest substep",
                       errors[b][0].rms, kAccuracyHeartLeapfrogLimit);
  }
}

}  // namespace viscera::bench
