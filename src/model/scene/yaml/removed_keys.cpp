// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scene/yaml/removed_keys.h"

namespace viscera {

namespace {

struct Removed {
  const char* key;    ///< path without indices
  const char* value;  ///< "": the key itself was removed
  const char* instead;
};

constexpr Removed kRemoved[] = {
    {"solver.integrator", "multigrid",
     "use leapfrog; solver.start: equilibrium settles stiff tissue before it is stepped"},
    {"solver.integrator", "auto", "use leapfrog, the default"},
    {"solver.integrator", "verlet_paper",
     "use leapfrog; `viscera bench accuracy` compares it with the integrator of the papers"},
    {"bodies.structure", "tetrahedra", "use lattice; it takes its shape from a Gmsh .msh file of volumes"},
    {"bodies.material.cells", "",
     "use material.law: neo_hookean (the default of lattices), or springs, which has only full or empty cells"},
    {"bodies.material.thin_walls", "", "remove it; material.law: neo_hookean has partly filled cells"},
    {"collision.search", "", "remove it; the search for contacts is complete"},
    {"collision.partitions", "", "remove it; the search for contacts is complete"},
    {"collision.window", "", "remove it; the search for contacts is complete"},
    {"solver.spring_forces", "", "remove it; each node sums the forces of its springs"},
};

std::string withoutIndices(const std::string& key) {
  std::string out;
  bool inside = false;
  for (const char c : key) {
    if (c == '[') inside = true;
    if (!inside) out += c;
    if (c == ']') inside = false;
  }
  return out;
}

}  // namespace

std::string removedNote(const std::string& key, const std::string& value) {
  const std::string plain = withoutIndices(key);
  for (const Removed& removed : kRemoved) {
    if (plain == removed.key && value == removed.value) return std::string("was removed: ") + removed.instead;
  }
  return "";
}

}  // namespace viscera
