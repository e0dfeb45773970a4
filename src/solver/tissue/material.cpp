// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/solver/material.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/decompositions.h"

namespace viscera {

namespace {

/// Returns [slots] twice the stiffness with which the cells of a law around a node resist a change of volume in
/// addition to its springs [N/m].
std::vector<double> volumeStiffness(const Body& body) {
  const Lattice& lattice = body.lattice;
  const double body_bulk = bodyParams(body, 0).bulk_j;
  const bool parts = isHeterogeneous(body);
  const Strengths table = parts ? strengths(body) : Strengths{};
  std::vector<double> volume(lattice.nodes.size());
  for (uint32_t slot : lattice.active_slots) {
    if (!(lattice.nodes[slot].lo & layout::kCellBit)) continue;
    const double bulk = parts ? table.bulk_j[slot] : body_bulk;
    if (bulk <= 0) continue;
    forEachCorner(lattice, slot, [&](const Vector3i&, uint32_t corner) {
      volume[corner] += 1.5 * bulk / (lattice.spacing_m * lattice.spacing_m);
    });
  }
  return volume;
}

/// Returns a bound on the square of the highest frequency of a body's nodes [1/s^2].
double stiffestRate(const Body& body) {
  const Lattice& lattice = body.lattice;
  const layout::BodyParams params = bodyParams(body, 0);
  const bool parts = isHeterogeneous(body);
  const Strengths table = parts ? strengths(body) : Strengths{};
  const std::vector<double> volume = volumeStiffness(body);
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

/// Returns stiffestRate() of a body with explicit connections: all its springs count, including those against bending.
double stiffestLinkedRate(const Body& body) {
  const SpringNetwork& network = *body.network;
  std::vector<double> stiffness(network.positions_m.size());
  for (const NetworkSpring& spring : network.springs) {
    stiffness[spring.a] += 2 * spring.stiffness_n_per_m;
    stiffness[spring.b] += 2 * spring.stiffness_n_per_m;
  }
  double fastest = 0;
  for (const uint32_t slot : body.lattice.active_slots) {
    if (!isFixed(body.lattice.nodes[slot])) fastest = std::max(fastest, stiffness[slot] / network.masses_kg[slot]);
  }
  return fastest;
}

/// Returns an upper bound on the speed of waves longer than a spring [m/s]: c^2 = largest eigenvalue of sum of k d d^T
/// over 2 m. It is exact along a chain of springs and 15 % too high in a regular sheet.
double fastestWave(const SpringNetwork& network) {
  std::vector<Eigen::Matrix3d> sums(network.positions_m.size(), Eigen::Matrix3d::Zero());
  for (const NetworkSpring& spring : network.springs) {
    const Vector3d d = network.positions_m[spring.b] - network.positions_m[spring.a];
    sums[spring.a] += spring.stiffness_n_per_m * d * d.transpose();
    sums[spring.b] += spring.stiffness_n_per_m * d * d.transpose();
  }
  double fastest2 = 0;
  for (size_t slot = 0; slot < sums.size(); ++slot) {
    if (network.masses_kg[slot] <= 0) continue;
    fastest2 = std::max(fastest2, principalValues(sums[slot]).z() / (2 * network.masses_kg[slot]));
  }
  return std::sqrt(fastest2);
}

}  // namespace

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
  params.mass_damping_per_s = static_cast<float>(material.mass_damping_per_s);
  // c = 2 xi k / omega_max with omega_max = 2 / dt_safe (physics.md 2).
  params.dashpot_s = static_cast<float>(material.stiffness_damping_ratio * dt_safe_s);
  params.law = material.law == Law::kNeoHookean ? layout::kLawNeoHookean : layout::kLawSprings;
  if (params.law != layout::kLawSprings) {
    params.bulk_j = static_cast<float>(e.bulk_j);
    params.rigidity_j = static_cast<float>(e.rigidity_j);
    params.stiffening = static_cast<float>(material.stiffening);
  }
  params.connections = !body.network              ? layout::kImplicit
                       : body.network->of_lattice ? layout::kExplicitLattice
                                                  : layout::kNetwork;
  return params;
}

std::vector<layout::BodyParams> bodyParams(const Model& model, double dt_safe_s) {
  std::vector<layout::BodyParams> params;
  for (const Body& body : model.bodies) params.push_back(bodyParams(body, dt_safe_s));
  return params;
}

bool hasLaw(const Model& model) {
  return std::any_of(model.bodies.begin(), model.bodies.end(),
                     [](const Body& body) { return body.material.law == Law::kNeoHookean; });
}

bool predictsSprings(const Model& model) {
  return std::any_of(model.bodies.begin(), model.bodies.end(), [](const Body& body) {
    return !body.network && body.material.law != Law::kNeoHookean && body.material.stiffness_damping_ratio > 0;
  });
}

double massOf_kg(const Body& body) {
  double mass = 0;
  if (body.network) {
    for (const double node : body.network->masses_kg) mass += node;
    return mass;
  }
  const bool differs = isHeterogeneous(body);
  const Strengths table = differs ? strengths(body) : Strengths{};
  const double eighth = bodyParams(body, 0).mass_eighth_kg;
  for (const uint32_t slot : body.lattice.active_slots) {
    mass += differs ? table.mass_kg[slot] : massEighths(body.lattice.nodes[slot]) * eighth;
  }
  return mass;
}

bool isHeterogeneous(const Model& model) {
  return std::any_of(model.bodies.begin(), model.bodies.end(), [](const Body& body) { return isHeterogeneous(body); });
}

double safeTimeStep(const Model& model) {
  double fastest = 0;
  for (const Body& body : model.bodies) {
    fastest = std::max(fastest, body.network ? stiffestLinkedRate(body) : stiffestRate(body));
  }
  return fastest > 0 ? 2 / std::sqrt(fastest) : std::numeric_limits<double>::infinity();
}

double pushSpeed(const Model& model) {
  return 4 * waveSpeed(model);
}

double waveSpeed(const Model& model) {
  double fastest = 0;
  for (const Body& body : model.bodies) {
    if (!body.hasCells()) {
      fastest = std::max(fastest, fastestWave(*body.network));
      continue;
    }
    forEachMaterial(body, [&](double young, double nu, double density) {
      const double p_modulus = young * (1 - nu) / ((1 + nu) * (1 - 2 * nu));
      fastest = std::max(fastest, std::sqrt(p_modulus / density));
    });
  }
  return fastest;
}

}  // namespace viscera
