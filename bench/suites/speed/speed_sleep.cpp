// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "bench/harness/rate.h"
#include "bench/suites/speed/speed_parts.h"
#include "solver/cpu/cpu_solver.h"
#include "solver/gpu/gpu_solver.h"

namespace viscera::bench {

namespace {

constexpr double kAsleepOverAwake = 50;  // cost ratio
constexpr double kOfShare = 2;           // cost of a probed corner relative to the share of bricks that are awake
constexpr double kSleepError = 0.01;     // relative to the largest displacement
constexpr double kSettle_s = 1.5, kDrag_per_s = 60, kProbeRadius_m = 0.006, kPress_m = 0.001;

/// Returns a probe at rest, pressed into the lowest corner.
ToolMotions pressedCorner() {
  return probeAt(Vector3d::Constant((kPress_m - kProbeRadius_m) / std::sqrt(3.0)));
}

double awakeShare(const Solver& solver) {
  const auto share = [](const auto& known) {
    return static_cast<double>(known.awakeBricks()) / static_cast<double>(known.bricks());
  };
  if (const auto* gpu = dynamic_cast<const GpuSolver*>(&solver)) return share(*gpu);
  return share(dynamic_cast<const CpuSolver&>(solver));
}

/// Cost of a tick of two settled bodies, only one of which may sleep.
struct Cost {
  double awake_us, asleep_us, share;
};

Cost costOf(int edge, const ToolMotions& motions, bool on_gpu, double seconds) {
  const Specimen wakeful = restingCube(edge, false, 0), sleepy = restingCube(edge, true, 0);
  const auto a = on_gpu ? onGpu(wakeful) : onCpu(wakeful), b = on_gpu ? onGpu(sleepy) : onCpu(sleepy);
  // A body without a probe is at rest from the start, and asleep after a few tenths of a second.
  const bool probed = motions[0].mode != ToolMode::kNone;
  const double settle_s = on_gpu && !probed ? kSettle_s / 5 : kSettle_s;
  settle(*a, wakeful.scene, motions, on_gpu ? 0 : settle_s);
  settle(*b, sleepy.scene, motions, settle_s);
  const std::vector<Rate> rates =
      measureRates({candidate("", a, wakeful.nodes(), motions), candidate("", b, sleepy.nodes(), motions)}, seconds);
  const double us = 1e6 * kSpecimenSubsteps;
  return {us / rates[0].substeps_per_s, us / rates[1].substeps_per_s, awakeShare(*b)};
}

void addRow(Table& table, const std::string& what, const std::string& backend, const Cost& cost) {
  table.add({what, backend, cost.awake_us, cost.asleep_us, cost.awake_us / cost.asleep_us, cost.share});
}

/// Returns the effect of falling asleep on a sagging body: largest difference over largest displacement.
double sleepError(int edge) {
  const Specimen wakeful = restingCube(edge, false, 9.81), sleepy = restingCube(edge, true, 9.81);
  const auto a = onCpu(wakeful), b = onCpu(sleepy);
  settle(*a, wakeful.scene, {}, kSettle_s);
  settle(*b, sleepy.scene, {}, kSettle_s);
  const HostState truth = a->readState(), slept = b->readState();
  double worst = 0, size = 0;
  for (uint32_t slot : wakeful.model.bodies[0].lattice.active_slots) {
    const Vector3d u = xyz(truth.displacement_m[slot]);
    worst = std::max(worst, (xyz(slept.displacement_m[slot]) - u).norm());
    size = std::max(size, u.norm());
  }
  return worst / size;
}

}  // namespace

Specimen restingCube(int edge, bool sleeps, double gravity_m_per_s2) {
  MaterialConfig material = specimenMaterial(0.2);
  material.mass_damping_per_s = kDrag_per_s;
  Specimen out = cubeOf(edge, material);
  Lattice& lattice = out.model.bodies[0].lattice;
  for (uint32_t slot : lattice.active_slots) {
    if (lattice.nodeAt(slot).z() == edge - 1) lattice.nodes[slot].lo |= layout::kFixedBit;
  }
  out.start = restState(out.model);
  out.scene.environment.gravity_m_per_s2 = Vector3d(0, 0, -gravity_m_per_s2);
  out.scene.solver.sleep_speed_m_per_s = sleeps ? SolverConfig{}.sleep_speed_m_per_s : 0;
  out.scene.styluses.resize(1);
  out.scene.styluses[0].probe.radius_m = kProbeRadius_m;
  return out;
}

void settle(Solver& solver, const Scene& scene, const ToolMotions& motions, double seconds) {
  for (double t = 0; t < seconds; t += 1 / scene.solver.tick_hz) stepAndWait(solver, motions);
}

void measureSleep(Report& report) {
  const int edge = report.isShort() ? 16 : 35;
  const double seconds = report.isShort() ? 0.02 : 0.2;
  Table table("tissue at rest, cube of " + std::to_string(edge * edge * edge) +
                  " nodes held at its top, dashpot 0.2, " + std::to_string(kSpecimenSubsteps) + " substeps a tick",
              {{"what"},
               {"backend"},
               {"may not sleep", "us/tick"},
               {"may sleep", "us/tick"},
               {"times cheaper", "", 3},
               {"bricks awake", "share", 3}});
  report.stage("asleep");
  const Cost rest = costOf(edge, {}, false, seconds);
  addRow(table, "at rest", "cpu", rest);
  report.stage("a probed corner");
  const Cost corner = costOf(edge, pressedCorner(), false, seconds);
  addRow(table, "one corner probed", "cpu", corner);
  report.stage("asleep, gpu");
  const Cost on_gpu = costOf(edge, {}, true, seconds);
  addRow(table, "at rest", "gpu", on_gpu);
  report.stage("a probe far away, gpu");
  const Cost hovering = costOf(edge, probeAt(Vector3d::Constant(10)), true, seconds);
  addRow(table, "a probe far away", "gpu", hovering);
  report.stage("a probed corner, gpu");
  addRow(table, "one corner probed", "gpu", costOf(edge, pressedCorner(), true, seconds));
  report.add(table, "sleep");
  report.checkAtLeast("sleep: awake over asleep on the GPU backend, cost of a tick", on_gpu.awake_us / on_gpu.asleep_us,
                      kAsleepOverAwake);
  report.checkAtLeast("sleep: the same with a probe far away", hovering.awake_us / hovering.asleep_us,
                      kAsleepOverAwake);
  report.checkAtLeast("sleep: awake over asleep, cost of a tick", rest.awake_us / rest.asleep_us, kAsleepOverAwake);
  report.checkAtMost("sleep: probed corner, share of cost over share of bricks awake",
                     corner.asleep_us / corner.awake_us / corner.share, kOfShare);
  report.stage("effect of sleeping");
  report.checkAtMost("sleep: change of a sagging body, of the largest displacement",
                     sleepError(report.isShort() ? 10 : 20), kSleepError);
}

}  // namespace viscera::bench
