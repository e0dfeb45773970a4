// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/model/body/elasticity.h"

#include <algorithm>

#include "math/nearest_names.h"
#include "model/body/mixed_cells.h"
#include "model/scene/key_location.h"
#include "viscera/math/error.h"

namespace viscera {

namespace {

/// Returns the constants of a cell with this share of tissue.
Elasticity scaled(const Elasticity& e, double share) {
  return {share * e.spring_n_per_m, share * e.bulk_j, share * e.rigidity_j, share * e.cell_mass_kg};
}

/// Returns (slot, full cell) for cells that share materials, in place of the constants of the cell's part. The energy
/// of a cell is an integral, so these are the means by volume.
std::vector<std::pair<size_t, Elasticity>> mixtures(const Lattice& lattice, const std::vector<Elasticity>& by_label) {
  std::vector<std::pair<size_t, Elasticity>> out;
  forEachMixedCell(lattice, by_label, [&](size_t first, size_t last) {
    Elasticity sum{};
    double share = 0;
    for (size_t i = first; i < last; ++i) {
      const Elasticity part = scaled(by_label[lattice.shared[i].label], lattice.shared[i].fill.share);
      sum.spring_n_per_m += part.spring_n_per_m;
      sum.bulk_j += part.bulk_j;
      sum.rigidity_j += part.rigidity_j;
      sum.cell_mass_kg += part.cell_mass_kg;
      share += lattice.shared[i].fill.share;
    }
    out.push_back({lattice.shared[first].cell, scaled(sum, 1 / share)});
  });
  return out;
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

/// Applies VR05's uniform weights: the average over the cells around, at the full count of an inner spring or node.
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

std::vector<Elasticity> elasticityByLabel(const Body& body) {
  const double h = body.lattice.spacing_m;
  const MaterialConfig& m = body.material;
  std::vector<Elasticity> out(1 + body.lattice.part_names.size(),
                              elasticity(m.young_modulus_pa, m.poisson_ratio, m.density_kg_per_m3, h));
  for (const PartConfig& part : body.parts) {
    const auto& names = body.lattice.part_names;
    const auto name = std::find(names.begin(), names.end(), part.part);
    const std::string key = "parts[" + std::to_string(&part - body.parts.data()) + "]";
    if (name == names.end()) {
      throw BodyKeyError(body.name, key,
                         " names '" + part.part + "'; the parts are " + nearestFirstText(part.part, names));
    }
    if (std::count_if(body.parts.begin(), body.parts.end(), [&](const PartConfig& p) { return p.part == part.part; }) >
        1)
      throw BodyKeyError(body.name, key, " names '" + part.part + "' twice");
    out[static_cast<size_t>(name - names.begin()) + 1] =
        elasticity(part.young_modulus_pa, part.poisson_ratio, part.density_kg_per_m3, h);
  }
  return out;
}

bool isHeterogeneous(const Body& body) {
  return !body.parts.empty() || !body.lattice.fills.empty() || !body.prestress.empty();
}

Strengths strengths(const Body& body) {
  const Lattice& lattice = body.lattice;
  const std::vector<Elasticity> by_label = elasticityByLabel(body);
  const size_t slots = lattice.nodes.size();
  Sums sums{std::vector<double>(slots * kSpringPairs), std::vector<double>(slots),
            std::vector<uint8_t>(slots * kSpringPairs), std::vector<uint8_t>(slots)};
  Strengths out;
  const bool has_law = body.material.law == Law::kNeoHookean;
  out.bulk_j.resize(slots);
  out.rigidity_j.resize(slots);
  const std::vector<std::pair<size_t, Elasticity>> mixed = mixtures(lattice, by_label);
  auto next = mixed.begin();
  for (uint32_t slot = 0; slot < slots; ++slot) {
    if (lattice.cell_labels[slot] == 0) continue;
    const bool mixes = next != mixed.end() && next->first == slot;
    const Elasticity& whole = mixes ? (next++)->second : by_label[lattice.cell_labels[slot]];
    const Elasticity e = scaled(whole, fillOf(lattice, slot).share);
    if (has_law) out.bulk_j[slot] = static_cast<float>(e.bulk_j);
    if (has_law) out.rigidity_j[slot] = static_cast<float>(e.rigidity_j);
    addCell(lattice, slot, e, sums);
  }
  if (body.material.weights == Weights::kPaper) makeUniform(sums);
  out.spring_n_per_m.assign(sums.spring.begin(), sums.spring.end());
  out.mass_kg.assign(sums.mass.begin(), sums.mass.end());
  return out;
}

namespace {

/// Replaces the moments of cells that share materials by those of their tissue, weighted by its rigidity.
void weighShared(const Body& body, CellMoments& out) {
  const Lattice& lattice = body.lattice;
  const std::vector<Elasticity> by_label = elasticityByLabel(body);
  out.of_cell.resize(lattice.nodes.size());
  forEachMixedCell(lattice, by_label, [&](size_t first, size_t last) {
    CellFill sum{0, Vector3d::Zero(), Eigen::Matrix3d::Zero()};
    for (size_t i = first; i < last; ++i) {
      const CellFill& part = lattice.shared[i].fill;
      const double weight = by_label[lattice.shared[i].label].rigidity_j;
      sum.share += weight * part.share;
      sum.first += weight * part.first;
      sum.second += weight * part.second;
    }
    const size_t cell = lattice.shared[first].cell;
    const double full = fillOf(lattice, static_cast<uint32_t>(cell)).share, scale = full / sum.share;
    out.fills.push_back({full, scale * sum.first, scale * sum.second});
    out.of_cell[cell] = static_cast<uint32_t>(out.fills.size());
  });
}

/// Share below which a cell is a sliver, and the largest increase of its second moments, over those of a full cell.
constexpr double kSliver = 0.2, kLeastMoment = 0.1;

/// Raises the second moments of slivers. Nodes that only slivers hold bend and twist with almost no resistance and
/// would fall out of the tissue. A cell of a hyperelastic law therefore gets small second moments about its centroid;
/// its small share keeps their effect negligible.
void raiseSlivers(std::vector<CellFill>& fills) {
  for (CellFill& fill : fills) {
    const double lacks = std::max(0.0, 1 - fill.share / kSliver);
    fill.second += fill.share * kLeastMoment / 12 * lacks * lacks * Eigen::Matrix3d::Identity();
  }
}

}  // namespace

CellMoments cellMoments(const Body& body) {
  CellMoments out{body.lattice.cell_fills, body.lattice.fills};
  if (!body.lattice.shared.empty() && !body.parts.empty()) weighShared(body, out);
  if (body.material.law == Law::kNeoHookean) raiseSlivers(out.fills);
  return out;
}

}  // namespace viscera
