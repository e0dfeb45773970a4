// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "bench/harness/machine/machine.h"
#include "bench/harness/rate.h"
#include "bench/harness/specimens/scalar_lattice.h"
#include "bench/suites/speed/speed_parts.h"
#include "solver/cpu/cpu_solver.h"
#include "viscera/gpu/context.h"

namespace viscera::bench {

namespace {

constexpr double kTarget = 42745;      // number of nodes of VR05's pig heart; the closest cube has 42,875
constexpr double kSideBySide = 1.2e5;  // number of nodes above which only cubes are measured, one after the other
constexpr double kGpuUpTo = 400e3;     // largest number of nodes, unless requested or not on a software renderer
constexpr double kFlatFrom = 9e3, kFlatUpTo = 1.1e6;

// Limits on two cores with AVX-512.
constexpr double kRate_per_s = 400e6, kOverScalar = 10, kOverSoftwareGpu = 4, kTwoThreads = 1.7;
constexpr double kHeartOverCube = 1.3;  // ratio of the cost of a node
constexpr double kFlat = 1.5;           // highest to lowest cost of a node from 10,000 to a million

/// VR05 Table 1: iterations per second of its CPU and of its implicit GPU method, by number of nodes.
struct Table1Printed {
  double cpu, gpu;
};
const std::map<int, Table1Printed> kTable1Paper = {{10000, {45.8, 839.8}},
                                                   {20000, {20.2, 476.9}},
                                                   {40000, {9.9, 264.6}},
                                                   {50000, {7.8, 218.0}},
                                                   {100000, {3.3, 104.1}}};

Candidate scalarOf(const Specimen& specimen) {
  const double dt_s = 1 / (specimen.scene.solver.tick_hz * kSpecimenSubsteps);
  auto lattice = std::make_shared<ScalarLattice>(specimen.model, specimen.start, dt_s);
  return {"scalar loop", static_cast<double>(lattice->nodes()), [lattice] {
            for (int s = 0; s < kSpecimenSubsteps; ++s) lattice->substep();
            return static_cast<double>(kSpecimenSubsteps);
          }};
}

enum ScalarOrSimd { kScalar, kOneThread, kAllThreads, kGpu, kVariantCount };
const char* const kVariants[] = {"cpu scalar", "cpu simd, 1 thread", "cpu simd, all threads", "gpu"};

Candidate candidateOf(size_t variant, const Specimen& specimen) {
  if (variant == kScalar) return scalarOf(specimen);
  return candidate(kVariants[variant],
                   variant == kGpu ? onGpu(specimen) : onCpu(specimen, variant == kOneThread ? 1 : 0),
                   specimen.nodes());
}

/// Returns nodes per position in 4x4 planes of bricks that contain a node: the usable share of SIMD lanes.
double planeShare(const Model& model) {
  constexpr uint32_t kPlane = 16;
  const std::vector<uint32_t>& slots = model.bodies[0].lattice.active_slots;
  size_t planes = 0;
  for (size_t i = 0; i < slots.size(); ++i) planes += i == 0 || slots[i] / kPlane != slots[i - 1] / kPlane ? 1 : 0;
  return static_cast<double>(slots.size()) / static_cast<double>(kPlane * planes);
}

using Rates = std::map<size_t, Rate>;  // by ScalarOrSimd: those that were measured

class Sizes {
 public:
  explicit Sizes(Report& report) : report_(report), limits_(measureLimits(report)) {}

  void measure(int nodes) {
    const Specimen cube = cubeOf(edgeOf(nodes));
    const Rates of_cube = measureBody(cube, nodes);
    addPoints(static_cast<double>(cube.nodes()), of_cube);
    if (nodes > kSideBySide) return;
    const Specimen heart = heartOf(nodes);
    const Rates of_heart = measureBody(heart, nodes);
    if (nodes != (report_.isShort() ? 10000 : static_cast<int>(kTarget))) return;
    check(of_cube);
    report_.note("The heart fills " + Cell(filledShare(heart.model)).text(2) + " of its box, and " +
                 Cell(planeShare(heart.model)).text(2) + " of the planes of 4x4 nodes that hold one; the cube " +
                 Cell(planeShare(cube.model)).text(2) + " of its planes.\n");
    for (const size_t variant : {kAllThreads, kGpu}) {
      if (of_cube.count(variant) > 0)
        report_.checkAtMost(std::string("a node of the heart over one of the cube, ") + kVariants[variant],
                            of_heart.at(variant).ns_per_update() / of_cube.at(variant).ns_per_update(), kHeartOverCube);
    }
  }

  void finish() {
    Series cpu{"VR05 CPU", {}, {}}, gpu{"VR05 implicit GPU", {}, {}};
    for (const auto& [nodes, printed] : kTable1Paper) {
      cpu.x.push_back(nodes);
      gpu.x.push_back(nodes);
      cpu.y.push_back(printed.cpu);
      gpu.y.push_back(printed.gpu);
    }
    rates_.series.insert(rates_.series.end(), {cpu, gpu});
    report_.add(table_, "sizes");
    report_.add(rates_, "sizes");
    report_.add(costs_, "costs");
    if (dearest_ns_ > 0)
      report_.checkAtMost("most expensive over cheapest node, 10k to 1M nodes, cpu, all threads",
                          dearest_ns_ / cheapest_ns_, kFlat);
  }

 private:
  std::vector<size_t> variantsFor(size_t nodes) const {
    std::vector<size_t> out;
    for (const Backend backend : report_.backends()) {
      const bool small = static_cast<double>(nodes) < kGpuUpTo || !report_.nodes().empty();
      if (backend == Backend::kGpu && (small || !report_.context()->isSoftware())) out.push_back(kGpu);
      if (backend != Backend::kCpu) continue;
      if (static_cast<double>(nodes) <= kSideBySide) out.push_back(kScalar);
      out.insert(out.end(), {kOneThread, kAllThreads});
    }
    return out;
  }

  /// Measures without dashpot, and with one for small bodies. @return rates without dashpot
  Rates measureBody(Specimen specimen, int nodes) {
    const bool small = nodes <= kSideBySide;
    Rates out;
    for (const double dashpot : small ? std::vector<double>{0, 0.2} : std::vector<double>{0}) {
      specimen.model.bodies[0].material.stiffness_damping_ratio = dashpot;
      report_.stage(specimen.name + " of " + std::to_string(specimen.nodes()) + " nodes, dashpot " +
                    Cell(dashpot).text(2));
      Rates rates = ratesOf(specimen, small);
      addRows(specimen, dashpot, rates, nodes);
      if (dashpot == 0) out = std::move(rates);
    }
    return out;
  }

  /// Measures the methods in turn, except those of large bodies, which would not fit into memory together.
  Rates ratesOf(const Specimen& specimen, bool in_turn) {
    const std::vector<size_t> variants = variantsFor(specimen.nodes());
    const double seconds = report_.isShort() ? 0.02 : 0.1, before = residentBytes();
    Rates out;
    std::vector<Candidate> candidates;
    bytes_ = 0;
    for (const size_t variant : variants) {
      candidates.push_back(candidateOf(variant, specimen));
      if (variant == kOneThread && !in_turn)
        bytes_ = (residentBytes() - before) / static_cast<double>(specimen.nodes());
      if (in_turn) continue;
      out[variant] = measureRates(candidates, seconds)[0];
      candidates.clear();
    }
    if (!in_turn) return out;
    const std::vector<Rate> rates = measureRates(candidates, seconds);
    for (size_t c = 0; c < variants.size(); ++c) out[variants[c]] = rates[c];
    return out;
  }

  void addRows(const Specimen& specimen, double dashpot, const Rates& rates, int nodes) {
    const Work work = workOf(specimen.model, dashpot);
    const auto paper = kTable1Paper.find(nodes);
    for (const auto& [variant, rate] : rates) {
      const auto over = [&, &rate = rate](size_t other) {
        const auto found = rates.find(other);
        return found == rates.end() ? Cell("") : Cell(rate.node_updates_per_s / found->second.node_updates_per_s);
      };
      const bool simd = variant == kOneThread || variant == kAllThreads;
      const Limits& limits = variant == kOneThread ? limits_.one : limits_.all;
      table_.add(
          {specimen.name, static_cast<double>(specimen.nodes()), dashpot, kVariants[variant], rate.substeps_per_s,
           rate.node_updates_per_s * 1e-6, rate.ns_per_update(), over(kScalar), over(kGpu),
           simd ? Cell(rate.node_updates_per_s * work.flop / limits.fma) : "",
           simd ? Cell(rate.node_updates_per_s * work.bytes / limits.copy) : "",
           variant == kOneThread && bytes_ > 0 ? Cell(bytes_) : "", rate.spread,
           paper == kTable1Paper.end() ? Cell("") : Cell(variant == kScalar ? paper->second.cpu : paper->second.gpu)});
    }
  }

  void addPoints(double nodes, const Rates& rates) {
    for (const auto& [variant, rate] : rates) {
      for (Plot* plot : {&rates_, &costs_}) {
        const auto named = [&, variant = variant](const Series& series) { return series.name == kVariants[variant]; };
        auto series = std::find_if(plot->series.begin(), plot->series.end(), named);
        if (series == plot->series.end()) series = plot->series.insert(series, Series{kVariants[variant], {}, {}});
        series->x.push_back(nodes);
        series->y.push_back(plot == &rates_ ? rate.substeps_per_s : rate.ns_per_update());
      }
    }
    const auto all = rates.find(kAllThreads);
    if (all == rates.end() || nodes < kFlatFrom || nodes > kFlatUpTo) return;
    cheapest_ns_ = std::min(cheapest_ns_, all->second.ns_per_update());
    dearest_ns_ = std::max(dearest_ns_, all->second.ns_per_update());
  }

  void check(const Rates& cube) {
    if (cube.count(kAllThreads) == 0) return;
    const double best = cube.at(kAllThreads).node_updates_per_s;
    const auto over = [&](size_t variant) { return best / cube.at(variant).node_updates_per_s; };
    report_.checkAtLeast("cube: M node updates/s, cpu, all threads", best * 1e-6, kRate_per_s * 1e-6);
    report_.checkAtLeast("cube: cpu, all threads, over the scalar loop", over(kScalar), kOverScalar);
    if (cube.count(kGpu) > 0 && report_.context()->isSoftware())
      report_.checkAtLeast("cube: cpu, all threads, over the software gpu", over(kGpu), kOverSoftwareGpu);
    if (processors() > 1) report_.checkAtLeast("cube: all threads over one", over(kOneThread), kTwoThreads);
  }

  Report& report_;
  MachineLimits limits_;
  Table table_{
      "cubes and hollow hearts by size; VR05 Table 1: its CPU next to the scalar loop, its implicit GPU next to "
      "the others",
      {{"body"},
       {"nodes", "", 8},
       {"dashpot"},
       {"way"},
       {"rate", "substeps/s"},
       {"updates", "M node updates/s"},
       {"cost", "ns/update"},
       {"over scalar", "", 3},
       {"over gpu", "", 3},
       {"of multiply-add rate", "", 3},
       {"of copy rate", "", 3},
       {"memory of the solver per node", "bytes"},
       {"spread", "", 2},
       {"VR05", "iterations/s"}}};
  Plot rates_{"Substeps per second, solid cube, no dashpot", "nodes", "substeps/s", true, true, {}};
  Plot costs_{"Cost of a node, solid cube, no dashpot", "nodes", "ns per node update", true, true, {}};
  double bytes_ = 0;  ///< per node, of the last body; 0: not measured
  double cheapest_ns_ = std::numeric_limits<double>::infinity(), dearest_ns_ = 0;
};

}  // namespace

void measureSizes(Report& report) {
  std::vector<int> nodes = report.nodes();
  if (nodes.empty())
    nodes = report.isShort() ? std::vector<int>{1000, 10000}
                             : std::vector<int>{1000,  3000,   10000,  20000,   static_cast<int>(kTarget),
                                                50000, 100000, 300000, 1000000, 10000000};
  Sizes sizes(report);
  for (const int size : nodes) sizes.measure(size);
  sizes.finish();
}

/// Measures one after the other, since the choice of instruction set applies to the whole process.
void measureSimd(Report& report) {
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
  onCpu(cube);  // selects the best again
  report.add(table, "simd");
}

}  // namespace viscera::bench
