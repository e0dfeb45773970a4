// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// A block of tissue on a plane: on a slope, sliding, and under others.
#include <algorithm>
#include <array>
#include <cmath>

#include "bench/harness/specimens/block.h"
#include "bench/suites/material/material_parts.h"
#include "model/scene/integrators.h"

namespace viscera::bench {

namespace {

constexpr double kSpacing_m = 0.005, kGravity_m_per_s2 = 9.81;
constexpr double kTick_hz = 60;
constexpr double kSlides = 0.03;    ///< relative to Coulomb's acceleration: a sliding block oscillates
constexpr double kStays_m = 5e-4;   ///< accepted settling and creep of a block that sticks [m]: a tenth of a spacing
constexpr double kStands_m = 5e-3;  ///< accepted offset of a box in a stack from its initial position [m]: a spacing,
                                    ///< including its own sag and the contact distance
constexpr double kRests_m_per_s = 5e-3;

MaterialConfig stiffTissue() {
  MaterialConfig material;
  material.young_modulus_pa = 1e5;
  material.mass_damping_per_s = 0;  // it would slow down sliding
  return material;
}

Scene onPlane(double friction, double slope_deg) {
  Scene scene;
  scene.environment.gravity_m_per_s2 = Vector3d(0, 0, -kGravity_m_per_s2);
  scene.solver.tick_hz = kTick_hz;
  ObstacleConfig plane;
  plane.rotation_deg = Vector3d(0, slope_deg, 0);
  plane.friction = friction;
  scene.obstacles = {plane};
  return scene;
}

/// Mean position and velocity of a body, weighted by mass.
struct Middle {
  Vector3d at_m = Vector3d::Zero(), speed_m_per_s = Vector3d::Zero();
};
Middle middleOf(const Model& model, size_t b, const HostState& state) {
  const Lattice& lattice = model.bodies[b].lattice;
  Middle out;
  double eighths = 0;
  for (uint32_t local : lattice.active_slots) {
    const uint32_t slot = model.slotOffset(b) + local;
    const double weight = massEighths(lattice.nodes[local]);
    out.at_m += weight * (lattice.restPosition(local) + xyz(state.displacement_m[slot]));
    out.speed_m_per_s += weight * xyz(state.velocity_m_per_s[slot]);
    eighths += weight;
  }
  return {out.at_m / eighths, out.speed_m_per_s / eighths};
}

/// A block of 4 x 4 x 2 cells on the slope, with a given initial speed along it.
struct Slide {
  double start_s, end_s;         ///< time span that is evaluated [s]
  double speed_m_per_s = 0;      ///< initial speed [m/s]
  double acceleration_m_per_s2;  ///< result: mean, down the slope [m/s2]
  double offset_m;               ///< result: displacement [m]
};
void slide(Backend backend, double friction, double slope_deg, Slide& run) {
  const Model model = blockModel({4, 4, 2}, kSpacing_m, stiffTissue());
  const Scene scene = onPlane(friction, slope_deg);
  const Quaterniond turn = rotationFromDegrees(scene.obstacles[0].rotation_deg);
  const Vector3d down = turn * Vector3d::UnitX();
  HostState state = restState(model);
  const Lattice& lattice = model.bodies[0].lattice;
  for (uint32_t slot : lattice.active_slots) {
    const Vector3d rest = lattice.restPosition(slot);
    state.displacement_m[slot] = vec4(turn * rest - rest);
    state.velocity_m_per_s[slot] = vec4(run.speed_m_per_s * down);
  }
  const std::unique_ptr<TissueStepper> solver = solverOn(backend, model, scene);
  solver->writeState(state);
  const auto run_to = [&](double& time_s, double end_s) {
    for (; time_s < end_s - 0.5 / kTick_hz; time_s += 1 / kTick_hz) solver->step({});
    return middleOf(model, 0, solver->readState());
  };
  double time_s = 0;
  const Middle first = run_to(time_s, run.start_s), last = run_to(time_s, run.end_s);
  run.acceleration_m_per_s2 = (last.speed_m_per_s - first.speed_m_per_s).dot(down) / (run.end_s - run.start_s);
  run.offset_m = (last.at_m - first.at_m).dot(down);
}

void measureSlopes(Report& report) {
  constexpr double kFriction = 0.4, kSlope = 0.05;  // slopes have tangents this much below and above the friction
  Table table("A block of 4x4x2 cells on a slope, friction 0.4, and pushed on a plane", {{"backend"},
                                                                                         {"slope", "tangent"},
                                                                                         {"friction"},
                                                                                         {"speed", "m/s"},
                                                                                         {"by Coulomb", "m/s2"},
                                                                                         {"measured", "m/s2"},
                                                                                         {"way", "m"}});
  for (Backend backend : report.backends()) {
    report.stage("slopes, " + nameOf(backend));
    double worst = 0, crept = 0;
    for (double tangent : {kFriction - kSlope, kFriction + kSlope}) {
      Slide run{0.25, 0.75, 0, 0, 0};
      const double angle = std::atan(tangent);
      slide(backend, kFriction, angle * 180 / M_PI, run);
      const double law = std::max(0.0, kGravity_m_per_s2 * (std::sin(angle) - kFriction * std::cos(angle)));
      table.add({nameOf(backend), tangent, kFriction, 0.0, law, run.acceleration_m_per_s2, run.offset_m});
      if (law > 0) worst = std::max(worst, std::abs(run.acceleration_m_per_s2 / law - 1));
      if (law == 0) crept = std::abs(run.offset_m);
    }
    for (double friction : {0.1, 0.3}) {
      Slide run{0.1, 0.3, 1.2, 0, 0};
      slide(backend, friction, 0, run);
      const double law = -friction * kGravity_m_per_s2;
      table.add({nameOf(backend), 0.0, friction, run.speed_m_per_s, law, run.acceleration_m_per_s2, run.offset_m});
      worst = std::max(worst, std::abs(run.acceleration_m_per_s2 / law - 1));
    }
    const std::string name = nameOf(backend) + ": contact: ";
    report.checkAtMost(name + "acceleration of a sliding block over Coulomb's, minus 1", worst, kSlides);
    report.checkAtMost(name + "displacement in half a second on a slope below the friction angle [m]", crept, kStays_m);
  }
  report.add(table, "slopes");
}

constexpr int kBoxes = 3, kHigh = 3;

/// Returns boxes of equal width, each slightly above its rest position on the one below.
Model stackedBoxes() {
  constexpr double kGap_m = 0.2 * kSpacing_m;
  Model model;
  for (int b = 0; b < kBoxes; ++b) {
    Model one = blockModel({4, 4, kHigh}, kSpacing_m, stiffTissue());
    one.bodies[0].name = "box" + std::to_string(b);
    one.bodies[0].lattice.origin_m.z() = b * ((kHigh + 1) * kSpacing_m + kGap_m);
    model.bodies.push_back(std::move(one.bodies[0]));
  }
  return model;
}

/// Measures a stack. @return largest offset of a box [m], largest speed of a box [m/s]
std::array<double, 2> measureStack(Backend backend, Integrator integrator, Table& table) {
  constexpr double kTime_s = 2, kImplicit = 5;  // kImplicit in units of dt_safe
  const bool is_explicit = traitsOf(integrator).is_explicit;
  Scene scene = onPlane(0.5, 0);
  scene.collision.enabled = true;
  scene.collision.friction = 0.5;
  scene.solver.integrator = integrator;
  if (!is_explicit) scene.solver.dt_fraction = kImplicit;
  const Model model = stackedBoxes();
  const std::unique_ptr<TissueStepper> solver = solverOn(backend, model, scene);
  std::vector<Middle> first;
  for (size_t b = 0; b < kBoxes; ++b) first.push_back(middleOf(model, b, solver->readState()));
  for (int t = 0; t < kTime_s * kTick_hz; ++t) solver->step({});
  double moved = 0, fastest = 0;
  for (size_t b = 0; b < kBoxes; ++b) {
    const Middle now = middleOf(model, b, solver->readState());
    const Vector3d away = now.at_m - first[b].at_m;
    const double speed = now.speed_m_per_s.norm();
    table.add({nameOf(backend), traitsOf(integrator).name, solver->dt_s() / solver->dtSafe_s(), static_cast<int>(b),
               std::hypot(away.x(), away.y()), -away.z(), speed});
    moved = std::max(moved, away.norm());
    fastest = std::max(fastest, speed);
  }
  return {moved, fastest};
}

/// Measures stacks, also with implicit integrators; in the short form, these on the CPU only.
void measureStacks(Report& report) {
  Table table("Three boxes on each other on a plane, after two seconds", {{"backend"},
                                                                          {"integrator"},
                                                                          {"dt", "dt_safe"},
                                                                          {"box"},
                                                                          {"aside", "m"},
                                                                          {"below its place", "m"},
                                                                          {"speed", "m/s"}});
  for (Backend backend : report.backends()) {
    for (const Integrator integrator : {Integrator::kLeapfrog, Integrator::kPd}) {
      if (report.isShort() && backend == Backend::kGpu && integrator != Integrator::kLeapfrog) continue;
      const std::string name = nameOf(backend) + ": stack, " + std::string(traitsOf(integrator).name);
      report.stage(name);
      const auto [moved_m, fastest_m_per_s] = measureStack(backend, integrator, table);
      report.checkAtMost(name + ": largest distance of a box from its place [m]", moved_m, kStands_m);
      report.checkAtMost(name + ": fastest box [m/s]", fastest_m_per_s, kRests_m_per_s);
    }
  }
  report.add(table, "stack");
}

}  // namespace

void measureContact(Report& report) {
  measureSlopes(report);
  measureStacks(report);
}

}  // namespace viscera::bench
