// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "math/number_text.h"
#include "math/vec4.h"
#include "solver/processes/process.h"
#include "solver/reference/reference_ticks.h"
#include "viscera/model/model.h"
#include "viscera/model/scene/scene.h"
#include "viscera/solver/solver.h"

namespace viscera::test {

inline std::string listText(const Vector3d& v) {
  return "[" + exactText(v.x()) + ", " + exactText(v.y()) + ", " + exactText(v.z()) + "]";
}

/// Returns a body: a box of tissue with its lower face at a height.
inline std::string boxText(const std::string& name, const Vector3d& size_m, double low_m, double spacing_m,
                           const std::string& more) {
  return "  - {name: " + name + ", source: box, box_size_m: " + listText(size_m) +
         ", position_m: " + listText({0, 0, low_m + 0.5 * size_m.z()}) + ", spacing_m: " + exactText(spacing_m) + ", " +
         more + "}\n";
}

/// Returns two free blocks, grown together, without damping.
inline Scene freeBlocks(const std::string& glue, const std::string& backend = "cpu") {
  // The tissue's own dashpots keep momentum, but not angular momentum.
  const char* const kUndamped =
      "material: {young_modulus_pa: 5000, poisson_ratio: 0.4, density_kg_per_m3: 1000, mass_damping_per_s: 0, "
      "stiffness_damping_ratio: 0}";
  return parseScene("bodies:\n" + boxText("low", {0.012, 0.012, 0.008}, 0, 0.004, kUndamped) +
                        boxText("top", {0.012, 0.012, 0.008}, 0.008, 0.002, kUndamped) +
                        "attachments: [{body_a: low, body_b: top, " + glue +
                        "}]\nenvironment: {gravity_m_per_s2: [0, 0, 0]}\nstyluses: [{name: hand, idle: none}]\n"
                        "solver: {backend: " +
                        backend + ", threads: 1, sleep_speed_m_per_s: 0}\n",
                    "free.yaml");
}

/// Returns two blocks with fibres that tear under a load. The lower one is held; nothing monitors stability.
inline Scene loadedBlocks(const std::string& backend = "cpu") {
  Scene scene = freeBlocks("modulus_pa: 5000, strength_pa: 500, toughness_j_per_m2: 0.5", backend);
  scene.solver.stability_monitor = scene.solver.measured_limit = false;
  scene.bodies[0].fixed.resize(1);
  scene.bodies[0].fixed[0].shape = FixedShape::kPlane;
  scene.environment.gravity_m_per_s2 = {3, 0, 9};
  return scene;
}

/// Steps a solver and the float64 reference, and compares their displacements.
inline void expectToMoveAsTheReference(const Model& model, const Scene& scene, Solver& solver, int ticks) {
  ReferenceTicks reference(model, scene);
  for (int t = 0; t < ticks; ++t) {
    solver.step(ToolMotions{});
    reference.step(ToolMotions{}, {});
  }
  const HostState state = solver.readState();
  double off_m = 0, most_m = 0;
  for (const uint32_t slot : reference.solver().active) {
    off_m = std::max(off_m, (xyz(state.displacement_m[slot]) - reference.solver().u_m[slot]).norm());
    most_m = std::max(most_m, reference.solver().u_m[slot].norm());
  }
  EXPECT_GT(most_m, 1e-4);
  EXPECT_LT(off_m, 1e-3 * most_m);
}

inline double factOf(const Solver& solver, const std::string& name) {
  for (const auto& process : solver.processes()) {
    const FactGroups groups = {process->facts()};
    if (const Fact::Value* const value = findFact(groups, "attachments", name)) return std::get<double>(*value);
  }
  return -1;
}

/// Returns a fact of the first attachment.
inline double factOfFirst(const Solver& solver, const std::string& name) {
  for (const auto& process : solver.processes()) {
    const FactGroups groups = {process->facts()};
    const Fact::Value* const on = findFact(groups, "attachments", "on");
    if (!on) continue;
    for (const Fact& fact : std::get<std::vector<Fact::Facts>>(*on).at(0)) {
      if (fact.name == name) return std::get<double>(fact.value);
    }
  }
  return -1;
}

}  // namespace viscera::test
