// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/model/body/elasticity.h"

#include <algorithm>

#include "viscera/math/error.h"

namespace viscera {

namespace {

/// [1 + parts] elasticity by label; label 0 has none.
std::vector<Elasticity> elasticityByLabel(const Body& body) {
  const double h = body.lattice.spacing_m;
  const MaterialConfig& m = body.material;
  std::vector<Elasticity> out(1 + body.lattice.part_names.size(),
                              elasticity(m.young_modulus_pa, m.poisson_ratio, m.density_kg_per_m3, h));
  for (const PartConfig& part : body.parts) {
    const auto& names = body.lattice.part_names;
    const auto name = std::find(names.begin(), names.end(), part.part);
    if (name == names.end()) {
      std::string known;
      for (const std::string& n : names) known += (known.empty() ? "" : ", ") + n;
      throw SceneError("body '" + body.name + "': 'parts' names '" + part.part + "'; the parts are " + known);
    }
    if (std::count_if(body.parts.begin(), body.parts.end(), [&](const PartConfig& p) { return p.part == part.part; }) >
        1)
      throw SceneError("body '" + body.name + "': 'parts' names '" + part.part + "' twice");
    out[static_cast<size_t>(name - names.begin()) + 1] =
        elasticity(part.young_modulus_pa, part.poisson_ratio, part.density_kg_per_m3, h);
  }
  return out;
}

/// Of a cell of which `share` is tissue.
Elasticity scaled(const Elasticity& e, double share) {
  return {share * e.spring_n_per_m, share * e.bulk_j, share * e.rigidity_j, share * e.cell_mass_kg};
}

/// Sums over the cells around each spring and node, in float64.
struct Sums {
  std::vector<double> spring, mass;  // [9 * slots], [slots]
  std::vector<uint8_t> spring_cells, node_cells;
};

void addCell(const Lattice& lattice, uint32_t lowest, const Elasticity& e, Sums& sums) {
  forEachCorner(lattice, lowest, [&](const Vector3i& a, uint32_t slot) {
    sums.mass[slot] += e.cell_mass_kg / 8;
    ++sums.node_cells[slot];
    forEachCorner(lattice, lowest, [&](const Vector3i& b, uint32_t) {
      const int spring = springIndex(b - a);
      if (spring < 0 || spring % 2) return;
      const size_t i = slot * kSpringPairs + static_cast<size_t>(spring) / 2;
      sums.spring[i] += e.spring_n_per_m * (isAxial(static_cast<uint32_t>(spring)) ? 0.25 : 0.5);
      ++sums.spring_cells[i];
    });
  });
}

/// VR05's uniform weights: what the cells around give on average, at the full count of an inner spring or node.
void makeUniform(Sums& sums) {
  for (size_t i = 0; i < sums.spring.size(); ++i) {
    const double full = i % kSpringPairs < layout::kAxialSprings / 2 ? 4 : 2;
    if (sums.spring_cells[i]) sums.spring[i] *= full / sums.spring_cells[i];
  }
  for (size_t i = 0; i < sums.mass.size(); ++i) {
    if (sums.node_cells[i]) sums.mass[i] *= 8.0 / sums.node_cells[i];
  }
}

}  // namespace

Elasticity elasticity(double young_modulus_pa, double poisson_ratio, double density_kg_per_m3, double spacing_m) {
  const double nu = poisson_ratio, h = spacing_m;
  const double mu = young_modulus_pa / (2 * (1 + nu));
  const double lambda_over_mu = 2 * nu / (1 - 2 * nu);
  const double bulk = nu == 0.25 ? 0 : (lambda_over_mu - 1) * mu * h * h * h;
  return {mu * h, bulk, mu * h * h * h, density_kg_per_m3 * h * h * h};
}

bool isHeterogeneous(const Body& body) {
  return !body.parts.empty() || !body.lattice.fills.empty();
}

Strengths strengths(const Body& body) {
  const Lattice& lattice = body.lattice;
  const std::vector<Elasticity> by_label = elasticityByLabel(body);
  const size_t slots = lattice.nodes.size();
  Sums sums{std::vector<double>(slots * kSpringPairs), std::vector<double>(slots),
            std::vector<uint8_t>(slots * kSpringPairs), std::vector<uint8_t>(slots)};
  Strengths out;
  const bool has_moments = body.material.cells == Cells::kMoments;
  out.bulk_j.resize(slots);
  if (has_moments) out.rigidity_j.resize(slots);
  for (uint32_t slot = 0; slot < slots; ++slot) {
    if (lattice.cell_labels[slot] == 0) continue;
    const Elasticity e = scaled(by_label[lattice.cell_labels[slot]], fillOf(lattice, slot).share);
    out.bulk_j[slot] = static_cast<float>(e.bulk_j);
    if (has_moments) out.rigidity_j[slot] = static_cast<float>(e.rigidity_j);
    addCell(lattice, slot, e, sums);
  }
  if (body.material.weights == Weights::kPaper) makeUniform(sums);
  out.spring_n_per_m.assign(sums.spring.begin(), sums.spring.end());
  out.mass_kg.assign(sums.mass.begin(), sums.mass.end());
  return out;
}

}  // namespace viscera
