// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scene/yaml/removed_keys.h"

namespace viscera {

namespace {

struct Removed {
  const char* key;    ///< without indices
  const char* value;  ///< ""; the key itself
  const char* instead;
};

constexpr Removed kRemoved[] = {
    {"solver.integrator", "multigrid",
     "use leapfrog; solver.start: equilibrium settles stiff tissue before it is stepped"},
    {"solver.integrator", "auto", "use leapfrog, the default"},
    {"solver.integrator", "verlet_paper",
     "use leapfrog; viscera bench accuracy compares the papers' integrator with it"},
    {"bodies.structure", "tetrahedra", "use lattice; a Gmsh .msh file of volumes is a shape for it"},
    {"bodies.material.cells", "",
     "use material.law: neo_hookean (the default of lattices) or springs, which has cells that are full or empty"},
    {"bodies.material.thin_walls", "", "leave it out; cells of material.law: neo_hookean are filled in part"},
    {"collision.search", "", "leave it out; the search for contacts is complete"},
    {"collision.partitions", "", "leave it out; the search for contacts is complete"},
    {"collision.window", "", "leave it out; the search for contacts is complete"},
    {"solver.spring_forces", "", "leave it out; each node sums the forces of its springs"},
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
