// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "bench/harness/specimens/block.h"
#include "bench/suites/material/material_parts.h"
#include "solver/reference/statics.h"

namespace viscera::bench {

namespace {

constexpr double kStrain = 1e-4;
constexpr double kMaterialTensionSpacing_m = 0.005;
constexpr double kMaterialTensionLimit = 1e-3;  ///< issue 3: for E relative to the given E, and for nu
/// Stiffness of an infinite rod with paper weights, relative to the given one (physics.md 1).
struct PaperExcess {
  int thickness;
  double factor;
};
constexpr PaperExcess kPaperExcess[] = {{1, 2.667}, {2, 1.733}, {4, 1.344}};

/// A square bar along z, pulled at its end faces, which stay plane and are free to contract.
struct Bar {
  int thickness, length;  ///< [cells]
  MaterialConfig material;
};

struct Elastic {
  double young_pa, poisson;
};

/// Material of a bar. Springs have nu 1/4 only.
struct TensionKind {
  const char* name;
  Law law;
  Weights weights;
};
constexpr TensionKind kTensionLaw = {"neo_hookean", Law::kNeoHookean, Weights::kCell},
                      kTensionSprings = {"springs", Law::kSprings, Weights::kCell},
                      kTensionPaper = {"springs, paper weights", Law::kSprings, Weights::kPaper};

MaterialConfig tissue(double nu, const TensionKind& kind) {
  MaterialConfig material;
  material.poisson_ratio = nu;
  material.law = kind.law;
  material.weights = kind.weights;
  material.mass_damping_per_s = material.stiffness_damping_ratio = 0;
  return material;
}

std::vector<PrescribedDof> pulled(const Lattice& lattice, const Bar& bar) {
  std::vector<PrescribedDof> out;
  for (uint32_t slot : lattice.active_slots) {
    const int z = lattice.nodeAt(slot).z();
    if (z == 0) out.push_back({slot, 2, 0});
    if (z == bar.length) out.push_back({slot, 2, kStrain * bar.length * kMaterialTensionSpacing_m});
  }
  const auto slotOf = [&](int x) { return static_cast<uint32_t>(lattice.slotAt({x, 0, 0})); };
  // Two nodes of one edge remove the remaining rigid motions.
  for (const PrescribedDof& pin : {PrescribedDof{slotOf(0), 0, 0}, {slotOf(0), 1, 0}, {slotOf(bar.thickness), 1, 0}}) {
    out.push_back(pin);
  }
  return out;
}

/// Returns the mean of a displacement component over the nodes for which `where` holds.
template <class Where>
double mean(const Lattice& lattice, const Field& u_m, int axis, Where where) {
  double sum = 0;
  int count = 0;
  for (uint32_t slot : lattice.active_slots) {
    if (!where(lattice.nodeAt(slot))) continue;
    sum += u_m[slot][axis];
    ++count;
  }
  return sum / count;
}

/// Returns the results of an extensometer on the middle half of the bar and a force gauge at its end.
/// @param force_n  [slots] elastic forces
Elastic elasticOf(const Lattice& lattice, const Bar& bar, const Field& u_m, const Field& force_n) {
  const int low = bar.length / 4, high = bar.length - low, middle = bar.length / 2, n = bar.thickness;
  const auto plane = [](int z) { return [z](const Vector3i& node) { return node.z() == z; }; };
  const double strain = (mean(lattice, u_m, 2, plane(high)) - mean(lattice, u_m, 2, plane(low))) /
                        ((high - low) * kMaterialTensionSpacing_m);
  const auto side = [&](int x) { return [=](const Vector3i& node) { return node.z() == middle && node.x() == x; }; };
  const double widening =
      (mean(lattice, u_m, 0, side(n)) - mean(lattice, u_m, 0, side(0))) / (n * kMaterialTensionSpacing_m);
  double pull = 0;
  for (uint32_t slot : lattice.active_slots) {
    if (lattice.nodeAt(slot).z() == 0) pull += force_n[slot].z();
  }
  return {pull / (std::pow(n * kMaterialTensionSpacing_m, 2) * strain), -widening / strain};
}

/// Returns the length of a bar. With paper weights its ends are stiffer than its middle, so it must be long.
int lengthOf(int thickness) {
  return thickness == 8 ? 3 * thickness : std::max(16, 5 * thickness);
}

/// Results of one bar, by the float64 reference and by the forces of backends in the same state.
struct Measured {
  Elastic reference;
  std::vector<Elastic> on;  ///< [backends]
};

Measured measure(const Bar& bar, const std::vector<Backend>& backends) {
  const Model model = blockModel({bar.thickness, bar.thickness, bar.length}, kMaterialTensionSpacing_m, bar.material);
  const Lattice& lattice = model.bodies[0].lattice;
  ReferenceSolver solver(model, Vector3d::Zero(), 1);
  solveStatics(solver, pulled(lattice, bar));
  Measured out{elasticOf(lattice, bar, solver.u_m, solver.elasticForces(solver.u_m)), {}};
  for (Backend backend : backends) {
    out.on.push_back(elasticOf(lattice, bar, solver.u_m, forcesOn(backend, model, solver.u_m)));
  }
  return out;
}

/// Tests of all bars: rows of the table, curves of the plot, largest errors.
class TensionTests {
 public:
  explicit TensionTests(const std::vector<Backend>& backends)
      : table("Tension: a square bar, n cells thick, stretched by 1e-4; measured over asked", columnsFor(backends)),
        plot{"Young's modulus measured in tension", "cells across", "abs(E / E asked - 1)", true, true, {}},
        worst_on(backends.size()),
        backends_(backends) {}

  void run(const TensionKind& kind, double nu, const std::vector<int>& thicknesses) {
    const bool by_cells = kind.weights == Weights::kCell;
    Series series{std::string(kind.name) + ", nu " + Cell(nu).text(3), {}, {}};
    for (int n : thicknesses) {
      const Bar bar{n, lengthOf(n), tissue(nu, kind)};
      const Measured found = measure(bar, backends_);
      const double asked = bar.material.young_modulus_pa, young = found.reference.young_pa / asked - 1,
                   poisson = found.reference.poisson - nu;
      std::vector<Cell> row = {kind.name, n, nu, young, poisson};
      for (size_t b = 0; b < backends_.size(); ++b) {
        const double on = found.on[b].young_pa / asked - 1;
        row.emplace_back(on);
        if (by_cells) worst_on[b] = std::max(worst_on[b], std::abs(on));
      }
      table.add(row);
      series.x.push_back(n);
      series.y.push_back(std::abs(young));
      if (by_cells) {
        worst_young = std::max(worst_young, std::abs(young));
        worst_poisson = std::max(worst_poisson, std::abs(poisson));
      }
      for (const PaperExcess& known : kPaperExcess) {
        if (by_cells || n != known.thickness) continue;
        worst_paper = std::max(worst_paper, std::abs(1 + young - known.factor));
      }
    }
    plot.series.push_back(series);
  }

  Table table;
  Plot plot;
  double worst_young = 0, worst_poisson = 0, worst_paper = 0;
  std::vector<double> worst_on;  ///< [backends] error of E by their forces

 private:
  static std::vector<Column> columnsFor(const std::vector<Backend>& backends) {
    std::vector<Column> out = {{"cells"}, {"n"}, {"nu asked"}, {"E/E_asked - 1"}, {"nu - nu_asked"}};
    for (Backend backend : backends) out.push_back({nameOf(backend) + ": E/E_asked - 1"});
    return out;
  }

  const std::vector<Backend>& backends_;
};

}  // namespace

void measureTension(Report& report) {
  TensionTests tests(report.backends());
  const auto run = [&](const TensionKind& kind, double nu) {
    report.stage(std::string("tension, ") + kind.name + ", nu " + Cell(nu).text(3));
    tests.run(kind, nu, report.isShort() ? std::vector<int>{1, 2} : std::vector<int>{1, 2, 4, 8});
  };
  for (double nu : {0.0, 0.25, 0.4, 0.45, 0.49}) run(kTensionLaw, nu);
  for (const TensionKind& kind : {kTensionSprings, kTensionPaper}) run(kind, 0.25);
  report.add(tests.table, "tension");
  report.add(tests.plot, "tension");
  report.checkAtMost("tension, cell weights: largest |E/E_asked - 1|", tests.worst_young, kMaterialTensionLimit);
  report.checkAtMost("tension, cell weights: largest |nu - nu_asked|", tests.worst_poisson, kMaterialTensionLimit);
  for (size_t b = 0; b < report.backends().size(); ++b) {
    report.checkAtMost("tension, cell weights, forces of " + nameOf(report.backends()[b]) + ": largest |E/E_asked - 1|",
                       tests.worst_on[b], kMaterialTensionLimit);
  }
  report.checkAtMost("tension, paper weights, nu 1/4: E/E_asked off the known excess", tests.worst_paper,
                     kMaterialTensionLimit);
}

}  // namespace viscera::bench
