// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/specimens/block.h"

#include "solver/tissue/joined_lattice.h"

namespace viscera::bench {

namespace {

Model modelOf(const Solid& solid, const MaterialConfig& material,
              const std::function<bool(const Vector3i& node)>& fixed) {
  Body body;
  body.name = "block";
  body.material = material;
  if (material.law == Law::kAuto) body.material.law = Law::kSprings;
  body.lattice = buildLattice(solid, material.weights);
  for (uint32_t slot : body.lattice.active_slots) {
    if (fixed && fixed(body.lattice.nodeAt(slot))) body.lattice.nodes[slot].lo |= layout::kFixedBit;
  }
  Model model;
  model.bodies.push_back(std::move(body));
  return model;
}

Solid solidBlock(const Vector3i& cells, double spacing_m) {
  Solid solid;
  solid.spacing_m = spacing_m;
  solid.cells = cells;
  solid.labels.assign(static_cast<size_t>(cells.prod()), 1);
  solid.part_names = {"block"};
  return solid;
}

}  // namespace

Model blockModel(const Vector3i& cells, double spacing_m, const MaterialConfig& material,
                 const std::function<bool(const Vector3i& node)>& fixed) {
  return modelOf(solidBlock(cells, spacing_m), material, fixed);
}

Model domeModel(int radius, double wall, double spacing_m, const MaterialConfig& material) {
  const Vector3i cells(2 * radius, 2 * radius, radius);
  Solid solid = solidBlock(cells, spacing_m);
  size_t cell = 0;
  for (int z = 0; z < cells.z(); ++z) {
    for (int y = 0; y < cells.y(); ++y) {
      for (int x = 0; x < cells.x(); ++x, ++cell) {
        const double r = Vector3d(x + 0.5 - radius, y + 0.5 - radius, z + 0.5).norm();
        if (r > radius || r < radius - wall) solid.labels[cell] = 0;
      }
    }
  }
  return modelOf(solid, material, [](const Vector3i& node) { return node.z() == 0; });
}

MaterialConfig unitMaterial() {
  MaterialConfig material;
  material.young_modulus_pa = 2.5;
  material.density_kg_per_m3 = 1;
  material.mass_damping_per_s = material.stiffness_damping_ratio = 0;
  return material;
}

std::string nameOf(Law law) {
  return law == Law::kNeoHookean ? "neo_hookean" : "springs";
}

MaterialConfig withPoisson(MaterialConfig material, double poisson_ratio) {
  material.poisson_ratio = poisson_ratio;
  material.law = poisson_ratio == MaterialConfig{}.poisson_ratio ? Law::kSprings : Law::kNeoHookean;
  return material;
}

Scene plainScene(const Model& model, int substeps, double dt_fraction) {
  Scene scene;
  scene.environment.gravity_m_per_s2 = Vector3d::Zero();
  scene.solver.dt_fraction = scene.solver.dt_fraction_strained = dt_fraction;
  scene.solver.substeps = substeps;
  scene.solver.stability_monitor = false;
  scene.solver.sleep_distance_m = 1e9;   // keeps the sleep test from interfering,
  scene.solver.sleep_speed_m_per_s = 0;  // so a small wave at its turning point does not count as rest
  scene.solver.tick_hz = 1 / (substeps * dt_fraction * safeTimeStep(model));
  return scene;
}

HostState restState(const Model& model) {
  return stateOf(model, Field(model.slots(), Vector3d::Zero()));
}

HostState stateOf(const Model& model, const Field& u_m) {
  HostState state;
  for (const Vector3d& u : u_m) state.displacement_m.push_back(vec4(u));
  state.velocity_m_per_s.assign(model.slots(), layout::vec4{});
  state.nodes = allNodes(model);
  return state;
}

Vector3d xyz(const layout::vec4& v) {
  return {v.x, v.y, v.z};
}

layout::vec4 vec4(const Vector3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()), 0};
}

Field forcesOn(Backend backend, const Model& model, const Field& u_m) {
  const std::unique_ptr<TissueStepper> solver = solverOn(backend, model, plainScene(model, 1));
  solver->writeState(stateOf(model, u_m));
  solver->step({});
  const HostState after = solver->readState();
  const ReferenceLattice lattice(model);  // provides the masses
  Field out(model.slots(), Vector3d::Zero());
  for (uint32_t slot : lattice.active) {
    out[slot] = lattice.mass(slot) * xyz(after.velocity_m_per_s[slot]) / (0.5 * solver->dt_s());
  }
  return out;
}

}  // namespace viscera::bench
