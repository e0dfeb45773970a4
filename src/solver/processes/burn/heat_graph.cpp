// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/burn/heat_graph.h"

#include <array>
#include <cmath>

#include "model/body/body_nodes.h"
#include "viscera/model/body/elasticity.h"
#include "viscera/model/body/neighbors.h"

namespace viscera {

namespace {

constexpr uint32_t kAxes = 3;

/// Returns BurntSpring::volume_ratio: springs resist an isotropic strain with 5 mu h^3, volumes with 3 (lambda - mu)
/// h^3.
double volumeRatio(const Elasticity& e) {
  return 0.6 * e.bulk_j / e.rigidity_j;
}

void addLatticeSprings(const Body& body, uint32_t offset, std::vector<BurntSpring>& out) {
  const Strengths table = strengths(body);
  const std::vector<Elasticity> elasticities = elasticityByLabel(body);
  const Lattice& lattice = body.lattice;
  for (const uint32_t slot : lattice.active_slots) {
    for (uint32_t pair = 0; pair < kSpringPairs; ++pair) {
      const auto k = static_cast<double>(table.spring_n_per_m[slot * kSpringPairs + pair]);
      const int64_t far = lattice.neighborSlot(slot, 2 * pair);
      if (k <= 0 || far < 0 || springCount(lattice.nodes[slot], 2 * pair) == 0) continue;
      const double length_m = (isAxial(2 * pair) ? 1 : std::sqrt(2.0)) * lattice.spacing_m;
      out.push_back({offset + slot, offset + static_cast<uint32_t>(far), BurntSpring::kOfLattice, 2 * pair, k, length_m,
                     volumeRatio(elasticities[lattice.labels[slot]])});
    }
  }
}

void addNetworkSprings(const Body& body, uint32_t offset, uint32_t first, std::vector<BurntSpring>& out) {
  const std::vector<NetworkSpring>& springs = body.network->springs;
  const std::vector<Elasticity> elasticities =
      body.network->of_lattice ? elasticityByLabel(body) : std::vector<Elasticity>();
  for (uint32_t i = 0; i < springs.size(); ++i) {
    const NetworkSpring& spring = springs[i];
    if (spring.against_bending || spring.stiffness_n_per_m <= 0) continue;
    const double ratio = elasticities.empty() ? 0 : volumeRatio(elasticities[body.lattice.labels[spring.a]]);
    out.push_back(
        {offset + spring.a, offset + spring.b, first + i, 0, spring.stiffness_n_per_m, spring.rest_length_m, ratio});
  }
}

/// Conductances of a lattice: of its cells along their edges, and exposed areas.
class CellHeat {
 public:
  CellHeat(const Lattice& lattice, double conductivity) : lattice_(lattice), w_per_k_(kAxes * lattice.nodes.size(), 0) {
    for (uint32_t slot = 0; slot < lattice_.nodes.size(); ++slot) {
      if (lattice_.cell_labels[slot] == 0) continue;
      const double of_edge = 0.25 * conductivity * lattice_.spacing_m * fillOf(lattice_, slot).share;
      forEachCorner(lattice_, slot, [&](const Vector3i& corner, uint32_t at) {
        for (uint32_t axis = 0; axis < kAxes; ++axis)
          if (corner[axis] == 0) w_per_k_[kAxes * at + axis] += of_edge;
      });
    }
  }
  /// Returns the conductance between two nodes that a spring connects: only along edges.
  double along(uint32_t a, uint32_t b) const {
    const int spring = springIndex(lattice_.nodeAt(b) - lattice_.nodeAt(a));
    if (spring < 0 || !isAxial(static_cast<uint32_t>(spring))) return 0;
    return w_per_k_[kAxes * (spring % 2 == 0 ? a : b) + static_cast<uint32_t>(spring) / 2];
  }
  double exposed_m2(uint32_t slot) const {
    std::array<bool, 8> there{};
    const Vector3i at = lattice_.nodeAt(slot);
    for (int c = 0; c < 8; ++c) {
      const int64_t lowest = lattice_.slotAt(at - Vector3i(c & 1, (c >> 1) & 1, (c >> 2) & 1));
      there[static_cast<size_t>(c)] = lowest >= 0 && lattice_.cell_labels[static_cast<size_t>(lowest)] != 0;
    }
    int faces = 0;
    for (size_t c = 0; c < 8; ++c) {
      for (size_t axis = 1; axis < 8; axis *= 2) faces += there[c] && !there[c ^ axis];
    }
    return 0.25 * faces * lattice_.spacing_m * lattice_.spacing_m;
  }

 private:
  const Lattice& lattice_;
  std::vector<double> w_per_k_;
};

/// Lists pairs by slot. @param pairs  with ends a and b   @param starts, of  out: start of each slot's indices in `of`
template <class Pair>
void listBySlot(const std::vector<Pair>& pairs, size_t slots, std::vector<uint32_t>& starts,
                std::vector<uint32_t>& of) {
  starts.assign(slots + 1, 0);
  for (const Pair& pair : pairs) {
    ++starts[pair.a + 1];
    ++starts[pair.b + 1];
  }
  for (size_t slot = 0; slot < slots; ++slot) starts[slot + 1] += starts[slot];
  of.resize(2 * pairs.size());
  std::vector<uint32_t> next(starts.begin(), starts.end() - 1);
  for (uint32_t i = 0; i < pairs.size(); ++i) {
    of[next[pairs[i].a]++] = i;
    of[next[pairs[i].b]++] = i;
  }
}

}  // namespace

bool BurntSpring::isCut(const CutSprings& cuts) const {
  if (number == kOfLattice) return springCount(cuts.nodes[a], of_a) == 0;
  return !cuts.spring_cut.empty() && cuts.spring_cut[number] > 0;
}

std::vector<BurntSpring> springsOf(const Model& model) {
  std::vector<BurntSpring> out;
  uint32_t first = 0;
  for (uint32_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    if (body.network) {
      addNetworkSprings(body, model.slotOffset(b), first, out);
      first += static_cast<uint32_t>(body.network->springs.size());
    } else {
      addLatticeSprings(body, model.slotOffset(b), out);
    }
  }
  return out;
}

HeatGraph::HeatGraph(const Model& model, double conductivity_w_per_m_k)
    : springs(springsOf(model)), mass_kg(model.slots(), 0), volume_m3(model.slots(), 0), exposed_m2(model.slots(), 0) {
  size_t next = 0;
  for (uint32_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    const uint32_t offset = model.slotOffset(b);
    size_t first = next;
    while (next < springs.size() && springs[next].a < offset + body.lattice.nodes.size()) ++next;
    addMasses(body, offset);
    if (hasOwnNetwork(body)) {
      addNetwork(*body.network, body.material.young_modulus_pa, offset, first, next, conductivity_w_per_m_k);
    } else {
      addCells(body.lattice, offset, first, next, conductivity_w_per_m_k);
    }
  }
  listBySlot(links, model.slots(), starts, links_of);
  listBySlot(springs, model.slots(), spring_starts, springs_of);
}

void HeatGraph::addMasses(const Body& body, uint32_t offset) {
  const std::vector<float> masses = body.network ? std::vector<float>() : strengths(body).mass_kg;
  forEachNode(body, [&](uint32_t slot) {
    mass_kg[offset + slot] = body.network ? body.network->masses_kg[slot] : static_cast<double>(masses[slot]);
    volume_m3[offset + slot] = mass_kg[offset + slot] / body.material.density_kg_per_m3;
  });
}

void HeatGraph::addCells(const Lattice& lattice, uint32_t offset, size_t first, size_t end, double conductivity) {
  spacing_m.push_back(lattice.spacing_m);
  const CellHeat cells(lattice, conductivity);
  for (const uint32_t slot : lattice.active_slots) exposed_m2[offset + slot] = cells.exposed_m2(slot);
  for (size_t s = first; s < end; ++s) {
    const double w_per_k = cells.along(springs[s].a - offset, springs[s].b - offset);
    if (w_per_k > 0) links.push_back({springs[s].a, springs[s].b, static_cast<uint32_t>(s), w_per_k});
  }
}

/// Adds a network. Springs represent isotropic conduction as they do stiffness: their sum of k l^2 n n^T over a sheet
/// is 3/2 E.
void HeatGraph::addNetwork(const SpringNetwork& network, double young_modulus_pa, uint32_t offset, size_t first,
                           size_t end, double conductivity) {
  spacing_m.push_back(network.meanLength());
  for (const std::array<uint32_t, 3>& t : network.triangles) {
    const std::vector<Vector3d>& at = network.positions_m;
    const double area_m2 = 0.5 * (at[t[1]] - at[t[0]]).cross(at[t[2]] - at[t[0]]).norm();
    for (const uint32_t slot : t) exposed_m2[offset + slot] += 2 * area_m2 / 3;
  }
  const double per_stiffness = 2.0 / 3 * conductivity / young_modulus_pa;
  for (size_t s = first; s < end; ++s)
    links.push_back(
        {springs[s].a, springs[s].b, static_cast<uint32_t>(s), per_stiffness * springs[s].stiffness_n_per_m});
}

}  // namespace viscera
