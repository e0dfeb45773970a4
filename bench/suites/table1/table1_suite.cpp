// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "bench/harness/machine/machine.h"
#include "bench/harness/rate.h"
#include "bench/harness/specimens/scalar_lattice.h"
#include "bench/suites/pace/performance_suites.h"
#include "bench/suites/table1/table1_parts.h"
#include "solver/cpu/cpu_solver.h"

namespace viscera::bench {

namespace {

constexpr double kTarget = 42745;  // nodes of VR05's pig heart; the cube next to it has 42,875

// What must be reached on two cores with AVX-512.
constexpr double kRate_per_s = 400e6, kOverScalar = 10, kOverSoftwareGpu = 4, kTwoThreads = 1.7, kHeartOverCube = 0.6;

/// VR05 Table 1: iterations per second of its CPU and of its implicit GPU method.
struct Table1Printed {
  double nodes, cpu, gpu;
};
constexpr Table1Printed kTable1Paper[] = {
    {10000, 45.8, 839.8}, {20000, 20.2, 476.9}, {40000, 9.9, 264.6}, {50000, 7.8, 218.0}, {100000, 3.3, 104.1}};

const Table1Printed* printedFor(double nodes) {
  for (const Table1Printed& row : kTable1Paper) {
    if (row.nodes == nodes) return &row;
  }
  return nullptr;
}

Candidate scalarOf(const Specimen& specimen) {
  const double dt_s = 1 / (specimen.scene.solver.tick_hz * kSpecimenSubsteps);
  auto lattice = std::make_shared<ScalarLattice>(specimen.model, specimen.start, dt_s);
  return {"scalar loop", static_cast<double>(lattice->nodes()), [lattice] {
            for (int s = 0; s < kSpecimenSubsteps; ++s) lattice->substep();
            return static_cast<double>(kSpecimenSubsteps);
          }};
}

enum ScalarOrSimd { kScalar, kOneThread, kAllThreads, kGpu };
const char* const kWays[] = {"cpu scalar", "cpu simd, 1 thread", "cpu simd, all threads", "gpu"};

std::vector<Candidate> candidatesOf(const Specimen& specimen) {
  return {scalarOf(specimen), candidate(kWays[kOneThread], onCpu(specimen, 1), specimen.nodes()),
          candidate(kWays[kAllThreads], onCpu(specimen), specimen.nodes()),
          candidate(kWays[kGpu], onGpu(specimen), specimen.nodes())};
}

using Rates = std::vector<Rate>;  // by ScalarOrSimd

void addRows(Table& table, const Specimen& specimen, double dashpot, const Rates& rates, const Table1Printed* printed) {
  for (size_t c = 0; c < rates.size(); ++c) {
    table.add({specimen.name, static_cast<double>(specimen.nodes()), dashpot, kWays[c], rates[c].substeps_per_s,
               rates[c].node_updates_per_s * 1e-6, rates[c].node_updates_per_s / rates[kScalar].node_updates_per_s,
               rates[c].node_updates_per_s / rates[kGpu].node_updates_per_s, rates[c].spread,
               printed ? Cell(c == kScalar ? printed->cpu : printed->gpu) : Cell("")});
  }
}

Table table1() {
  return Table("VR05 Table 1; the paper's column: its CPU beside the scalar loop, its implicit GPU beside the others",
               {{"body"},
                {"nodes", "", 8},
                {"dashpot"},
                {"way"},
                {"rate", "substeps/s"},
                {"updates", "M node updates/s"},
                {"over scalar", "", 3},
                {"over gpu", "", 3},
                {"spread", "", 2},
                {"VR05", "iterations/s"}});
}

void addPoints(Plot& plot, const Rates& rates, double nodes) {
  for (size_t way = 0; way < rates.size(); ++way) {
    if (plot.series.size() <= way) plot.series.push_back({kWays[way], {}, {}});
    plot.series[way].x.push_back(nodes);
    plot.series[way].y.push_back(rates[way].substeps_per_s);
  }
}

void addPaper(Plot& plot) {
  Series cpu{"VR05 CPU", {}, {}}, gpu{"VR05 implicit GPU", {}, {}};
  for (const Table1Printed& row : kTable1Paper) {
    cpu.x.push_back(row.nodes);
    gpu.x.push_back(row.nodes);
    cpu.y.push_back(row.cpu);
    gpu.y.push_back(row.gpu);
  }
  plot.series.push_back(cpu);
  plot.series.push_back(gpu);
}

void checkCube(Report& report, const Rates& rates, bool software) {
  const double best = rates[kAllThreads].node_updates_per_s;
  report.checkAtLeast("cube: M node updates/s, cpu, all threads", best * 1e-6, kRate_per_s * 1e-6);
  report.checkAtLeast("cube: cpu, all threads, over the scalar loop", best / rates[kScalar].node_updates_per_s,
                      kOverScalar);
  if (software)
    report.checkAtLeast("cube: cpu, all threads, over the software gpu", best / rates[kGpu].node_updates_per_s,
                        kOverSoftwareGpu);
  if (processors() > 1)
    report.checkAtLeast("cube: all threads over one", best / rates[kOneThread].node_updates_per_s, kTwoThreads);
}

/// One body, without dashpot and with one. @return rates of the first
Rates measureBody(Report& report, Specimen specimen, const Table1Printed* printed, Table& table) {
  Rates out;
  for (double dashpot : {0.0, 0.2}) {
    specimen.model.bodies[0].material.dashpot_ratio = dashpot;
    report.stage(specimen.name + " of " + std::to_string(specimen.nodes()) + " nodes, dashpot " +
                 Cell(dashpot).text(2));
    const Rates rates = measureRates(candidatesOf(specimen), report.isShort() ? 0.02 : 0.1);
    addRows(table, specimen, dashpot, rates, printed);
    if (dashpot == 0) out = rates;
  }
  return out;
}

/// Cubes and hearts of the paper's sizes. Checks are about those of the pig heart's, without dashpot.
void measureSizes(Report& report, bool software) {
  Table table = table1();
  Plot plot{"Substeps per second, solid cube, no dashpot", "nodes", "substeps/s", true, true, {}};
  const std::vector<double> sizes =
      report.isShort() ? std::vector<double>{10000} : std::vector<double>{10000, 20000, 40000, kTarget, 50000, 100000};
  for (double size : sizes) {
    const Specimen cube = cubeOf(edgeOf(size));
    const Rates of_cube = measureBody(report, cube, printedFor(size), table);
    const Rates of_heart = measureBody(report, heartOf(static_cast<int>(size)), printedFor(size), table);
    addPoints(plot, of_cube, static_cast<double>(cube.nodes()));
    if (size != (report.isShort() ? sizes[0] : kTarget)) continue;
    checkCube(report, of_cube, software);
    report.checkAtLeast("heart over cube, per active node, cpu, all threads",
                        of_heart[kAllThreads].node_updates_per_s / of_cube[kAllThreads].node_updates_per_s,
                        kHeartOverCube);
  }
  addPaper(plot);
  report.add(table, "sizes");
  report.add(plot, "sizes");
}

/// One after the other: a choice of instruction set is the whole process's.
void measureTargets(Report& report) {
  const Specimen cube = cubeOf(report.isShort() ? 22 : 35);
  Table table("instruction sets, cube of " + std::to_string(cube.nodes()) + " nodes, no dashpot, 1 thread",
              {{"instruction set"}, {"updates", "M node updates/s"}, {"over scalar", "", 3}, {"spread", "", 2}});
  const double seconds = report.isShort() ? 0.02 : 0.3;
  const Rate scalar = measureRates({scalarOf(cube)}, seconds)[0];
  table.add({"scalar loop", scalar.node_updates_per_s * 1e-6, 1, scalar.spread});
  for (const std::string& simd : simdTargets()) {
    report.stage(simd);
    const Rate rate = measureRates({candidate(simd, onCpu(cube, 1, simd), cube.nodes())}, seconds)[0];
    table.add({simd, rate.node_updates_per_s * 1e-6, rate.node_updates_per_s / scalar.node_updates_per_s, rate.spread});
  }
  onCpu(cube);  // takes the best again
  report.add(table, "simd");
}

}  // namespace

void table1Suite(Report& report, gpu::Context& context) {
  measureSizes(report, context.isSoftware());
  measureExplicit(report);
  measureTargets(report);
  measurePressedHeart(report);
  measureHeartSessions(report, context);
}

}  // namespace viscera::bench
