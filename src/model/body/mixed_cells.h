// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "viscera/model/body/elasticity.h"
#include "viscera/model/body/lattice.h"

namespace viscera {

/// Returns whether two materials have the same elasticity and density.
inline bool isSame(const Elasticity& a, const Elasticity& b) {
  return a.spring_n_per_m == b.spring_n_per_m && a.bulk_j == b.bulk_j && a.cell_mass_kg == b.cell_mass_kg;
}

/// Calls visit(first, last) for the parts of every cell with several materials, indices into Lattice::shared.
/// @param by_label  elasticityByLabel()
template <class Visit>
void forEachMixedCell(const Lattice& lattice, const std::vector<Elasticity>& by_label, Visit visit) {
  const std::vector<PartFill>& shared = lattice.shared;
  for (size_t first = 0; first < shared.size();) {
    size_t last = first;
    bool differ = false;
    for (; last < shared.size() && shared[last].cell == shared[first].cell; ++last)
      differ = differ || !isSame(by_label[shared[last].label], by_label[shared[first].label]);
    if (differ) visit(first, last);
    first = last;
  }
}

}  // namespace viscera
