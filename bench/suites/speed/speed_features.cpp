// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "bench/harness/rate.h"
#include "bench/suites/speed/speed_parts.h"

namespace viscera::bench {

namespace {

constexpr int kComparedTicks = 3;
constexpr double kSameWithin = 1e-5;         // [spacings] float32 rounding of sixty substeps
constexpr double kSpeedFeaturesWave = 0.02;  // [spacings]
constexpr double kNothing = 1e-9;            // size of a feature that exists and has no effect in float32

Specimen specimen(int edge, double stiffness_damping_ratio = 0) {
  return cubeOf(edge, specimenMaterial(stiffness_damping_ratio));
}

/// Returns a stylus that acts where there is no tissue.
Feature toolInAir(const std::string& name, int edge, ToolMode mode) {
  Feature out{name, specimen(edge), specimen(edge), {}};
  out.with.scene.styluses.resize(1);
  out.with.scene.styluses[0].button1 = mode;
  out.motions_with[0].mode = mode;
  out.motions_with[0].present = true;
  out.motions_with[0].from.position_m = out.motions_with[0].to.position_m = Vector3d(10, 10, 10);
  return out;
}

/// Returns a part with the body's own elasticity.
Feature parts(int edge) {
  Feature out{"strengths by part", specimen(edge), specimen(edge), {}};
  Body& body = out.with.model.bodies[0];
  body.parts.push_back({body.lattice.part_names[0], body.material.young_modulus_pa, body.material.poisson_ratio,
                        body.material.density_kg_per_m3});
  return out;
}

/// Returns a vessel that is not cut.
Feature bleeding(int edge) {
  Feature out{"bleeding", specimen(edge), specimen(edge), {}};
  out.with.model.bodies[0].material.bleeding.flow_ml_per_min = 60;
  return out;
}

Feature solverKey(const std::string& name, int edge, const std::function<void(SolverConfig&)>& set) {
  Feature out{name, specimen(edge), specimen(edge), {}};
  set(out.with.scene.solver);
  return out;
}

/// Returns a body with its lower half fixed. Neither body drifts, since that would tear the other half off.
Feature fixedHalf(int edge) {
  Feature out{"fixed nodes (half of them)", specimen(edge), specimen(edge), {}, false};
  Lattice& lattice = out.without.model.bodies[0].lattice;
  for (uint32_t slot : lattice.active_slots) {
    if (2 * lattice.nodeAt(slot).z() < edge) lattice.nodes[slot].lo |= layout::kFixedBit;
  }
  for (Specimen* specimen : {&out.with, &out.without})
    specimen->start = wobbling(specimen->model, kSpeedFeaturesWave * lattice.spacing_m, 0);
  return out;
}

/// Returns a body with one cut spring in every brick, so that no brick is whole.
Feature cutState(int edge) {
  Feature out{"cut state (one spring in every brick)", specimen(edge), specimen(edge), {}, false};
  const Lattice& lattice = out.with.model.bodies[0].lattice;
  uint32_t last_brick = ~0u;
  for (uint32_t slot : lattice.active_slots) {
    if (slot / layout::kBrickSlots == last_brick || springCount(lattice.nodes[slot], 0) == 0) continue;
    last_brick = slot / layout::kBrickSlots;
    cutSpring(lattice, slot, 0, out.with.start.nodes);
  }
  return out;
}

}  // namespace

std::vector<Feature> featuresOf(int edge) {
  std::vector<Feature> out;
  out.push_back({"dashpot", specimen(edge, kNothing), specimen(edge), {}});
  out.push_back(parts(edge));
  out.push_back(toolInAir("contacts", edge, ToolMode::kProbe));
  out.push_back(toolInAir("cuts", edge, ToolMode::kCut));
  out.push_back(toolInAir("cautery", edge, ToolMode::kCautery));
  out.push_back(bleeding(edge));
  out.push_back(solverKey("compensated sums", edge, [](SolverConfig& solver) { solver.compensated = true; }));
  out.push_back(solverKey("stability_monitor", edge, [](SolverConfig& solver) { solver.stability_monitor = true; }));
  out.push_back(cutState(edge));
  out.push_back(fixedHalf(edge));
  return out;
}

namespace {

using Make = std::shared_ptr<TissueStepper> (*)(const Specimen&);
std::shared_ptr<TissueStepper> cpu(const Specimen& specimen) {
  return onCpu(specimen);
}

HostState after(const Specimen& specimen, Make make, const ToolMotions& motions) {
  const std::shared_ptr<TissueStepper> solver = make(specimen);
  for (int t = 0; t < kComparedTicks; ++t) solver->step(motions);
  return solver->readState();
}

/// Returns the largest difference of a displacement [spacings].
double difference(const Feature& feature, Make make) {
  const HostState a = after(feature.with, make, feature.motions_with), b = after(feature.without, make, {});
  const Lattice& lattice = feature.with.model.bodies[0].lattice;
  double worst = 0;
  for (uint32_t slot : lattice.active_slots)
    worst = std::max(worst, (xyz(a.displacement_m[slot]) - xyz(b.displacement_m[slot])).norm());
  return worst / lattice.spacing_m;
}

/// Adds a row. @return the difference, 0 if there is none to compare
double addRow(Table& table, const Feature& feature, const std::string& backend, Make make, const Rate& with,
              const Rate& without) {
  const double differs = feature.same_result ? difference(feature, make) : 0;
  table.add({feature.name, backend, 1e6 / with.substeps_per_s, 1e6 / without.substeps_per_s,
             without.substeps_per_s / with.substeps_per_s, std::max(with.spread, without.spread),
             feature.same_result ? Cell(differs) : Cell("")});
  return differs;
}

}  // namespace

void measureFeatures(Report& report) {
  const int edge = report.isShort() ? 12 : 35;
  Table table("features of the solver on a cube of " + std::to_string(edge * edge * edge) +
                  " nodes: on but without effect, and left out",
              {{"feature"},
               {"backend"},
               {"on", "us/substep"},
               {"left out", "us/substep"},
               {"on over left out", "", 3},
               {"spread", "", 2},
               {"largest difference", "spacings", 3}});
  double worst = 0;
  for (const Feature& feature : featuresOf(edge)) {
    report.stage(feature.name);
    const std::vector<Rate> rates =
        measureRates({candidate("", onCpu(feature.with), feature.with.nodes(), feature.motions_with),
                      candidate("", onCpu(feature.without), feature.without.nodes()),
                      candidate("", onGpu(feature.with), feature.with.nodes(), feature.motions_with),
                      candidate("", onGpu(feature.without), feature.without.nodes())},
                     report.isShort() ? 0.01 : 0.2);
    worst = std::max(worst, addRow(table, feature, "cpu", cpu, rates[0], rates[1]));
    worst = std::max(worst, addRow(table, feature, "gpu", onGpu, rates[2], rates[3]));
  }
  report.add(table, "features");
  report.checkAtMost("features: largest difference between on without effect and left out, spacings", worst,
                     kSameWithin);
}

}  // namespace viscera::bench
