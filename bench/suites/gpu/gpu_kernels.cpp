// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "bench/harness/machine/machine.h"
#include "bench/harness/specimens/specimen.h"
#include "bench/suites/gpu/gpu_parts.h"
#include "gpu/fence.h"
#include "gpu/stage_clock.h"
#include "solver/gpu/gpu_solver.h"

namespace viscera::bench {

namespace {

constexpr double kGiga = 1e-9;
constexpr int kTicks = 8, kRounds = 5;

/// Work of a kernel per node or cell: float32 operations (a fused multiply-add is two; a root or a division one), and
/// bytes of memory traffic if every repeated read hits a cache.
struct Cost {
  double flop, bytes;
};

// leapfrog.comp, spring.glsl. A spring: w 3, e 3, L 6, direction 3, extension 14, k 1, force 7. With a dashpot it is
// predicted: dv 3, predicted ends 6, test for mild states 14, damping 7.
// A node: acceleration 6, drag 3, velocity 17, displacement 6.
constexpr double kSpringFlop = 37, kPredictedFlop = 30, kNodeFlop = 32;
// cell_forces.comp, of a full cell without stiffening: predicted corners 48, their deformation modes 90
// (cell_modes.glsl), moments and ratios 22, cofactors and e 46, s 69, curvature correction 78, stress 75, derivatives
// by the modes 162, and forces of four pairs of corners 21 each. A node adds 3 for each of its eight cells, and has no
// springs.
constexpr double kLawFlop = 48 + 90 + 22 + 46 + 69 + 78 + 75 + 162 + 4 * 21, kCornersFlop = 8 * 3;
// An entry of the list, the node's bits, and vectors of four floats: u and v in and out; u and v in; 8 forces of a
// cell.
constexpr double kListed = 4 + 8, kVector = 16, kCellForces = 8 * kVector;
// Tables: of nine springs; of a mass and a depth; of a cell.
constexpr double kSpringTables = 9 * 4, kMassTables = 8, kCellTables = 16;

/// Material of the tissue.
struct Tissue {
  const char* name;
  double stiffness_damping_ratio, poisson_ratio;
  bool parts;  ///< whether tables have strengths and masses, as with parts or partially filled cells
  bool probe;  ///< whether there is a probe, out of reach
};
constexpr Tissue kTissues[] = {{"springs", 0, 0.25, false, false},
                               {"springs, dashpot", 0.2, 0.25, false, false},
                               {"springs, dashpot, tables", 0.2, 0.25, true, false},
                               {"neo_hookean, nu 0.45, dashpot", 0.2, 0.45, false, false},
                               {"the same, tables", 0.2, 0.45, true, false},
                               {"the same, tables, a probe", 0.2, 0.45, true, true}};

/// Returns whether the tissue has the neo-Hookean law; springs have nu 1/4.
bool isOfLaw(const Tissue& tissue) {
  return tissue.poisson_ratio != 0.25;
}

Cost costOfStep(const Tissue& tissue) {
  Cost out{kNodeFlop, kListed + 4 * kVector + (tissue.parts ? kMassTables : 0)};
  if (isOfLaw(tissue)) {
    out.flop += kCornersFlop;
    out.bytes += kCellForces;
    return out;
  }
  out.flop += 18 * (kSpringFlop + (tissue.stiffness_damping_ratio > 0 ? kPredictedFlop : 0));
  if (tissue.parts) out.bytes += kSpringTables;
  return out;
}

Cost costOfCells(const Tissue& tissue) {
  return {kLawFlop, kListed + 2 * kVector + kCellForces + (tissue.parts ? kCellTables : 0)};
}

Specimen specimenWith(const Tissue& tissue, int edge) {
  const MaterialConfig material = withPoisson(specimenMaterial(tissue.stiffness_damping_ratio), tissue.poisson_ratio);
  Specimen cube = cubeOf(edge, material);
  if (tissue.parts) {  // a part without cells, so that nothing else changes
    Body& body = cube.model.bodies[0];
    body.lattice.part_names.emplace_back("none");
    body.parts.push_back({"none"});
  }
  if (tissue.probe) cube.scene.styluses.resize(1);
  return cube;
}

/// Returns the seconds per substep of the stages of a tick, each in the best of the rounds.
std::array<double, gpu::kStages> timeStages(const Specimen& cube) {
  GpuSolver solver(cube.model, cube.scene);
  solver.writeState(cube.start);
  const ToolMotions motions = cube.scene.styluses.empty() ? ToolMotions() : probeAt(Vector3d(10, 0, 0));
  const auto run = [&](int ticks) {
    layout::TickStats stats;
    for (int t = 0; t < ticks; ++t) {
      solver.step(motions);
      while (solver.pollStats(stats, false)) {
      }
    }
    gpu::awaitGpu("a measurement");
  };
  warmUpGpu([&] { run(kTicks); });
  std::array<double, gpu::kStages> best;
  best.fill(1e9);
  for (int round = 0; round < kRounds; ++round) {
    gpu::StageClock clock;
    run(kTicks);
    const auto& times = clock.collect(true);
    for (size_t s = 0; s < gpu::kStages; ++s)
      best[s] = std::min(best[s], times[s].seconds / (kTicks * kSpecimenSubsteps));
  }
  return best;
}

/// The limits of the GPU: bytes/s, flop/s.
struct Limits {
  double copy, fma;
};

/// Rates against arithmetic intensity, below the roof given by the limits.
struct Roofline {
  Series step{"a node's step", {}, {}, Series::Style::kPoints}, cells{"cells", {}, {}, Series::Style::kPoints};

  Plot plot(const Limits& limits, const std::string& renderer) const {
    Plot out{"Kernels of leapfrog on " + renderer, "flop per byte", "GFLOP/s", true, true, {}};
    Series roof{"limits, measured", {}, {}, Series::Style::kLines};
    const double balance = limits.fma / limits.copy;
    for (const double x : {std::min(1.0, 0.25 * balance), balance, std::max(50.0, 4 * balance)}) {
      roof.x.push_back(x);
      roof.y.push_back(kGiga * std::min(limits.fma, limits.copy * x));
    }
    out.series = {roof, step, cells};
    return out;
  }
};

/// Time of one kernel.
struct Timed {
  const Tissue* tissue;
  const char* kernel;
  double nodes, seconds;
  Cost cost;
};

/// Returns the kernels of a cube in the order of execution.
std::vector<Timed> timeKernels(const Tissue& tissue, int edge) {
  const Specimen cube = specimenWith(tissue, edge);
  const double nodes = static_cast<double>(cube.nodes());
  const auto seconds = timeStages(cube);
  std::vector<Timed> out;
  if (isOfLaw(tissue))
    out.push_back(
        {&tissue, "cell_forces.comp", nodes, seconds[static_cast<size_t>(gpu::Stage::kCells)], costOfCells(tissue)});
  out.push_back({&tissue, "leapfrog.comp", nodes, seconds[static_cast<size_t>(gpu::Stage::kStep)], costOfStep(tissue)});
  return out;
}

void addRow(Table& table, Roofline& roofline, const Timed& timed, const Limits& limits) {
  const double rate = timed.nodes / timed.seconds;
  const double of_fma = rate * timed.cost.flop / limits.fma, of_copy = rate * timed.cost.bytes / limits.copy;
  table.add({timed.nodes, timed.tissue->name, timed.kernel, 1e6 * timed.seconds, kGiga * rate, timed.cost.flop,
             timed.cost.bytes, 100 * of_fma, 100 * of_copy, of_fma > of_copy ? "arithmetic" : "memory"});
  Series& series = std::string(timed.kernel) == "cell_forces.comp" ? roofline.cells : roofline.step;
  series.x.push_back(timed.cost.flop / timed.cost.bytes);
  series.y.push_back(kGiga * rate * timed.cost.flop);
}

Limits measureLimits(Report& report) {
  report.stage("copies and multiply-adds");
  return {gpuCopyRate(report.isShort() ? 32 : 256), gpuFmaRate(report.isShort() ? 0.1 : 1)};
}

}  // namespace

void measureKernels(Report& report) {
  const Limits before = measureLimits(report);
  std::vector<Timed> kernels;
  for (const int edge : report.isShort() ? std::vector<int>{22} : std::vector<int>{35, 100}) {
    for (const Tissue& tissue : kTissues) {
      report.stage(std::string(tissue.name) + ", " + std::to_string(edge) + " nodes to an edge");
      for (const Timed& timed : timeKernels(tissue, edge)) kernels.push_back(timed);
    }
  }
  const Limits after = measureLimits(report);  // a second measurement excludes other load of the machine
  const Limits limits{std::max(before.copy, after.copy), std::max(before.fma, after.fma)};
  Table measured("limits of this GPU", {{"of"}, {"before", "", 3}, {"after", "", 3}, {"unit"}});
  measured.add({"copies, read and written", kGiga * before.copy, kGiga * after.copy, "GB/s"});
  measured.add({"multiply-adds in registers", kGiga * before.fma, kGiga * after.fma, "GFLOP/s"});
  report.add(measured, "limits");
  Table table("kernels of a substep of leapfrog on cubes, and their share of the limits",
              {{"nodes", "", 8},
               {"tissue"},
               {"kernel"},
               {"substep", "us", 3},
               {"rate", "G/s", 3},
               {"flop per node"},
               {"bytes per node"},
               {"of multiply-add rate", "%", 3},
               {"of copy rate", "%", 3},
               {"nearer limit"}});
  Roofline roofline;
  for (const Timed& timed : kernels) addRow(table, roofline, timed, limits);
  report.note(
      "Operations and bytes are counted in the kernels' text. Bytes are those that no cache can save, so bodies that "
      "fit in a cache may exceed the copy rate. The larger share of the two limits counts.\n");
  report.add(table, "kernels");
  report.add(roofline.plot(limits, report.context()->renderer()), "roofline");
}

}  // namespace viscera::bench
