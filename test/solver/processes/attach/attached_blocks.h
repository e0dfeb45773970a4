// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "math/number_text.h"
#include "math/vec4.h"
#include "solver/processes/process.h"
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
