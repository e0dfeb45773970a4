// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/solver/material.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "viscera/math/error.h"

namespace viscera {

namespace {

/// Calls visit(corner, slot) for the eight nodes of the cell whose lowest corner is at `lowest`.
template <class Visit>
void forEachCorner(const Lattice& lattice, uint32_t lowest, Visit visit) {
  const Vector3i at = lattice.nodeAt(lowest);
  for (int c = 0; c < 8; ++c) {
    const Vector3i corner(c & 1, (c >> 1) & 1, (c >> 2) & 1);
    visit(corner, static_cast<uint32_t>(lattice.slotAt(at + corner)));
  }
}

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

/// Highest frequency that a body's nodes may have, squared [1/s^2].
double stiffestRate(const Body& body) {
  const Lattice& lattice = body.lattice;
  const layout::BodyParams params = bodyParams(body, 0);
  const bool parts = isHeterogeneous(body);
  const Strengths table = parts ? strengths(body) : Strengths{};
  std::vector<double> volume(lattice.nodes.size());
  for (uint32_t slot : lattice.active_slots) {
    if (!(lattice.nodes[slot].lo & layout::kCellBit)) continue;
    const double bulk = parts ? table.bulk_j[slot] : params.bulk_j;
    if (bulk <= 0) continue;
    forEachCorner(lattice, slot, [&](const Vector3i&, uint32_t corner) {
      volume[corner] += 1.5 * bulk / (lattice.spacing_m * lattice.spacing_m);
    });
  }
  double fastest = 0;
  for (uint32_t slot : lattice.active_slots) {
    const layout::NodeBits& bits = lattice.nodes[slot];
    if (isFixed(bits)) continue;
    double stiffness = volume[slot];
    for (uint32_t s = 0; s < layout::kSpringsPerNode; ++s) {
      const uint32_t count = springCount(bits, s);
      if (count == 0) continue;
      const uint32_t near = s % 2 ? static_cast<uint32_t>(lattice.neighborSlot(slot, s)) : slot;
      const double unit = isAxial(s) ? params.axial_quarter_n_per_m : params.diagonal_half_n_per_m;
      stiffness += 2 * (parts ? static_cast<double>(table.spring_n_per_m[near * kSpringPairs + s / 2]) : count * unit);
    }
    const double mass = parts ? table.mass_kg[slot] : massEighths(bits) * static_cast<double>(params.mass_eighth_kg);
    fastest = std::max(fastest, stiffness / mass);
  }
  return fastest;
}

template <class Visit>
void forEachMaterial(const Body& body, Visit visit) {
  visit(body.material.young_modulus_pa, body.material.poisson_ratio, body.material.density_kg_per_m3);
  for (const PartConfig& part : body.parts) visit(part.young_modulus_pa, part.poisson_ratio, part.density_kg_per_m3);
}

}  // namespace

Elasticity elasticity(double young_modulus_pa, double poisson_ratio, double density_kg_per_m3, double spacing_m) {
  const double nu = poisson_ratio, h = spacing_m;
  const double mu = young_modulus_pa / (2 * (1 + nu));
  const double lambda_over_mu = 2 * nu / (1 - 2 * nu);
  const double bulk = nu == 0.25 ? 0 : (lambda_over_mu - 1) * mu * h * h * h;
  return {mu * h, bulk, density_kg_per_m3 * h * h * h};
}

bool isHeterogeneous(const Body& body) {
  return !body.parts.empty();
}

Strengths strengths(const Body& body) {
  const Lattice& lattice = body.lattice;
  const std::vector<Elasticity> by_label = elasticityByLabel(body);
  const size_t slots = lattice.nodes.size();
  Sums sums{std::vector<double>(slots * kSpringPairs), std::vector<double>(slots),
            std::vector<uint8_t>(slots * kSpringPairs), std::vector<uint8_t>(slots)};
  Strengths out;
  out.bulk_j.resize(slots);
  for (uint32_t slot = 0; slot < slots; ++slot) {
    if (lattice.cell_labels[slot] == 0) continue;
    const Elasticity& e = by_label[lattice.cell_labels[slot]];
    out.bulk_j[slot] = static_cast<float>(e.bulk_j);
    addCell(lattice, slot, e, sums);
  }
  if (body.material.weights == Weights::kPaper) makeUniform(sums);
  out.spring_n_per_m.assign(sums.spring.begin(), sums.spring.end());
  out.mass_kg.assign(sums.mass.begin(), sums.mass.end());
  return out;
}

layout::BodyParams bodyParams(const Body& body, double dt_safe_s) {
  const double h = body.lattice.spacing_m;
  const MaterialConfig& material = body.material;
  const Elasticity e = elasticity(material.young_modulus_pa, material.poisson_ratio, material.density_kg_per_m3, h);
  layout::BodyParams params{};
  params.origin_spacing = {static_cast<float>(body.lattice.origin_m.x()), static_cast<float>(body.lattice.origin_m.y()),
                           static_cast<float>(body.lattice.origin_m.z()), static_cast<float>(h)};
  params.axial_quarter_n_per_m = static_cast<float>(e.spring_n_per_m / 4);
  params.diagonal_half_n_per_m = static_cast<float>(e.spring_n_per_m / 2);
  params.mass_eighth_kg = static_cast<float>(e.cell_mass_kg / 8);
  params.drag_per_s = static_cast<float>(material.drag_per_s);
  // c = 2 xi k / omega_max with omega_max = 2 / dt_safe (physics.md 2).
  params.dashpot_s = static_cast<float>(material.dashpot_ratio * dt_safe_s);
  params.bulk_j = static_cast<float>(e.bulk_j);
  return params;
}

std::vector<layout::BodyParams> bodyParams(const Model& model, double dt_safe_s) {
  std::vector<layout::BodyParams> params;
  for (const Body& body : model.bodies) params.push_back(bodyParams(body, dt_safe_s));
  return params;
}

bool hasVolumeEnergy(const Model& model) {
  bool any = false;
  for (const Body& body : model.bodies) {
    forEachMaterial(body, [&](double, double nu, double) { any |= nu != 0.25; });
  }
  return any;
}

bool isHeterogeneous(const Model& model) {
  return std::any_of(model.bodies.begin(), model.bodies.end(), [](const Body& body) { return isHeterogeneous(body); });
}

double safeTimeStep(const Model& model) {
  double fastest = 0;
  for (const Body& body : model.bodies) fastest = std::max(fastest, stiffestRate(body));
  return fastest > 0 ? 2 / std::sqrt(fastest) : std::numeric_limits<double>::infinity();
}

double pushSpeed(const Model& model) {
  return 4 * waveSpeed(model);
}

double waveSpeed(const Model& model) {
  double fastest = 0;
  for (const Body& body : model.bodies) {
    forEachMaterial(body, [&](double young, double nu, double density) {
      const double p_modulus = young * (1 - nu) / ((1 + nu) * (1 - 2 * nu));
      fastest = std::max(fastest, std::sqrt(p_modulus / density));
    });
  }
  return fastest;
}

}  // namespace viscera
