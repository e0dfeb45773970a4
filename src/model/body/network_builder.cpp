// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/body/network_builder.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include "model/body/network_order.h"
#include "viscera/model/body/elasticity.h"

namespace viscera {
namespace {

/// Contribution of one triangle to one of its edges.
struct EdgeShare {
  uint32_t a, b;  // a < b
  double area_m2;
  uint32_t opposite;  // third corner of the triangle
};

bool before(const EdgeShare& s, const EdgeShare& t) {
  return s.a != t.a ? s.a < t.a : s.b < t.b;
}

EdgeShare shareOf(uint32_t from, uint32_t to, double area_m2, uint32_t opposite) {
  return {std::min(from, to), std::max(from, to), area_m2, opposite};
}

void sortByEnds(std::vector<NetworkSpring>& springs) {
  std::stable_sort(springs.begin(), springs.end(),
                   [](const NetworkSpring& s, const NetworkSpring& t) { return s.a != t.a ? s.a < t.a : s.b < t.b; });
}

NetworkSpring springBetween(const SpringNetwork& network, uint32_t a, uint32_t b, double stiffness_n_per_m) {
  NetworkSpring spring;
  spring.a = std::min(a, b);
  spring.b = std::max(a, b);
  spring.stiffness_n_per_m = stiffness_n_per_m;
  spring.rest_length_m = (network.positions_m[b] - network.positions_m[a]).norm();
  return spring;
}

NetworkSpring bendingSpring(const SpringNetwork& network, uint32_t a, uint32_t b, double stiffness_n_per_m) {
  NetworkSpring spring = springBetween(network, a, b, stiffness_n_per_m);
  spring.against_bending = true;
  return spring;
}

/// Adds a spring between the vertices opposite to an edge, for every pair of triangles at it.
void addBending(std::vector<EdgeShare>::const_iterator first, std::vector<EdgeShare>::const_iterator last,
                double stiffness_n_per_m, const SpringNetwork& network, std::vector<NetworkSpring>& bending) {
  for (auto one = first; one != last; ++one) {
    for (auto other = one + 1; other != last; ++other) {
      if (one->opposite == other->opposite) continue;  // the same triangle twice
      bending.push_back(bendingSpring(network, one->opposite, other->opposite, stiffness_n_per_m));
    }
  }
}

/// Adds one spring per edge, of k = E t A / l^2.
void addSprings(std::vector<EdgeShare> shares, double modulus_n_per_m, double bending_ratio, SpringNetwork& network) {
  std::stable_sort(shares.begin(), shares.end(), before);
  std::vector<NetworkSpring> bending;
  for (auto first = shares.cbegin(); first != shares.cend();) {
    auto last = first;
    double area_m2 = 0;
    for (; last != shares.cend() && !before(*first, *last); ++last) area_m2 += last->area_m2;
    NetworkSpring spring = springBetween(network, first->a, first->b, 0);
    spring.stiffness_n_per_m = modulus_n_per_m * area_m2 / (spring.rest_length_m * spring.rest_length_m);
    network.springs.push_back(spring);
    if (bending_ratio > 0) addBending(first, last, bending_ratio * spring.stiffness_n_per_m, network, bending);
    first = last;
  }
  // Appended after the edges: of springs between the same two nodes, the edge's comes first.
  network.springs.insert(network.springs.end(), bending.begin(), bending.end());
  sortByEnds(network.springs);
}

double areaOf(const std::vector<Vector3d>& positions_m, const std::array<uint32_t, 3>& t) {
  return 0.5 * (positions_m[t[1]] - positions_m[t[0]]).cross(positions_m[t[2]] - positions_m[t[0]]).norm();
}

/// Returns whether a triangle has no area: below this height over length, three single-precision points are on one
/// line.
bool isDegenerate(const std::vector<Vector3d>& positions_m, const std::array<uint32_t, 3>& t) {
  constexpr double kFlat = 1e-7;
  double longest = 0;
  for (size_t e = 0; e < 3; ++e)
    longest = std::max(longest, (positions_m[t[e]] - positions_m[t[(e + 1) % 3]]).squaredNorm());
  return areaOf(positions_m, t) <= 0.5 * kFlat * longest;
}

/// Stiffness and mass in float32, as the kernels of the implicit lattice compute them.
class LatticeStrengths {
 public:
  explicit LatticeStrengths(const Body& body) : lattice_(body.lattice), has_parts_(isHeterogeneous(body)) {
    const MaterialConfig& m = body.material;
    const Elasticity e = elasticity(m.young_modulus_pa, m.poisson_ratio, m.density_kg_per_m3, lattice_.spacing_m);
    axial_quarter_ = static_cast<float>(e.spring_n_per_m / 4);
    diagonal_half_ = static_cast<float>(e.spring_n_per_m / 2);
    mass_eighth_ = static_cast<float>(e.cell_mass_kg / 8);
    if (has_parts_) table_ = strengths(body);
  }

  /// @param spring  even, as in the table of parts
  double springNPerM(uint32_t slot, uint32_t spring) const {
    const auto count = static_cast<float>(springCount(lattice_.nodes[slot], spring));
    const float k = has_parts_ && count > 0 ? table_.spring_n_per_m[slot * kSpringPairs + spring / 2]
                                            : count * (isAxial(spring) ? axial_quarter_ : diagonal_half_);
    return static_cast<double>(k);
  }
  double massKg(uint32_t slot) const {
    return static_cast<double>(has_parts_ ? table_.mass_kg[slot]
                                          : static_cast<float>(massEighths(lattice_.nodes[slot])) * mass_eighth_);
  }

 private:
  const Lattice& lattice_;
  bool has_parts_;
  float axial_quarter_, diagonal_half_, mass_eighth_;
  Strengths table_;
};

/// Returns which nodes are in a region one cell thick: one bit per axis across it.
std::vector<uint8_t> thinAxes(const Lattice& lattice) {
  std::vector<uint8_t> is_cell(lattice.nodes.size()), thick(lattice.nodes.size());
  for (const uint32_t slot : lattice.active_slots) is_cell[slot] = lattice.nodes[slot].lo & layout::kCellBit ? 1 : 0;
  const auto filled = [&](const Vector3i& cell) {
    const int64_t slot = lattice.slotAt(cell);
    return slot >= 0 && is_cell[static_cast<size_t>(slot)];
  };
  for (const uint32_t slot : lattice.active_slots) {
    if (!is_cell[slot]) continue;
    uint8_t across = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3i step = Vector3i::Unit(axis), at = lattice.nodeAt(slot);
      if (filled(at + step) || filled(at - step)) across |= static_cast<uint8_t>(1u << axis);
    }
    forEachCorner(lattice, slot, [&](const Vector3i&, uint32_t corner) { thick[corner] |= across; });
  }
  for (uint8_t& axes : thick) axes = static_cast<uint8_t>(~axes & 7u);
  return thick;
}

/// Adds springs of two spacings along sheets of one cell, each in line with two springs in the same direction.
void addSheetBending(const Lattice& lattice, const LatticeStrengths& strengths, double bending_ratio,
                     SpringNetwork& network) {
  const std::vector<uint8_t> thin = thinAxes(lattice);
  for (const uint32_t slot : lattice.active_slots) {
    for (uint32_t s = 0; s < layout::kSpringsPerNode; s += 2) {
      uint8_t across = 0;  // axes in which the spring has no extent
      for (uint32_t axis = 0; axis < 3; ++axis)
        across |= static_cast<uint8_t>((kNeighborOffsets[s][axis] == 0) << axis);
      const double near_k = strengths.springNPerM(slot, s);
      if (near_k == 0) continue;
      const auto middle = static_cast<uint32_t>(lattice.neighborSlot(slot, s));
      const double far_k = strengths.springNPerM(middle, s);
      if (far_k == 0) continue;
      const auto end = static_cast<uint32_t>(lattice.neighborSlot(middle, s));
      if ((thin[slot] & thin[middle] & thin[end] & across) == 0) continue;
      network.springs.push_back(bendingSpring(network, slot, end, bending_ratio * std::min(near_k, far_k)));
    }
  }
}

}  // namespace

SpringNetwork membraneNetwork(const TriangleMesh& mesh, const MaterialConfig& material, double thickness_m,
                              double bending_ratio, size_t* degenerate) {
  SpringNetwork network;
  for (const Vector3f& position : mesh.positions_m) network.positions_m.push_back(position.cast<double>());
  network.masses_kg.resize(mesh.positions_m.size());
  network.detail = mesh.detail;
  std::vector<EdgeShare> shares;
  for (const auto& t : mesh.triangles) {
    if (isDegenerate(network.positions_m, t)) {
      if (degenerate) ++*degenerate;
      continue;
    }
    const double area_m2 = areaOf(network.positions_m, t);
    for (size_t e = 0; e < 3; ++e) {
      shares.push_back(shareOf(t[e], t[(e + 1) % 3], area_m2, t[(e + 2) % 3]));
      network.masses_kg[t[e]] += material.density_kg_per_m3 * thickness_m * area_m2 / 3;
    }
    network.triangles.push_back(t);
    if (!mesh.charts.empty()) network.charts.push_back(mesh.charts[static_cast<size_t>(&t - mesh.triangles.data())]);
  }
  addSprings(std::move(shares), material.young_modulus_pa * thickness_m, bending_ratio, network);
  return network;
}

SpringNetwork latticeNetwork(const Body& body, double bending_ratio) {
  const Lattice& lattice = body.lattice;
  const LatticeStrengths strengths(body);
  SpringNetwork network;
  network.of_lattice = true;
  network.positions_m.assign(lattice.nodes.size(), Vector3d::Zero());
  network.masses_kg.resize(lattice.nodes.size());
  for (const uint32_t slot : lattice.active_slots) {
    network.positions_m[slot] = lattice.restPosition(slot);
    network.masses_kg[slot] = strengths.massKg(slot);
    for (uint32_t s = 0; s < layout::kSpringsPerNode; s += 2) {
      if (springCount(lattice.nodes[slot], s) == 0) continue;
      const auto far = static_cast<uint32_t>(lattice.neighborSlot(slot, s));
      NetworkSpring spring;
      spring.a = std::min(slot, far);
      spring.b = std::max(slot, far);
      spring.stiffness_n_per_m = strengths.springNPerM(slot, s);
      spring.rest_length_m = lattice.spacing_m * std::sqrt(isAxial(s) ? 1.0 : 2.0);
      spring.lattice_spring = slot < far ? s : oppositeSpring(s);
      network.springs.push_back(spring);
    }
  }
  if (bending_ratio > 0) addSheetBending(lattice, strengths, bending_ratio, network);
  sortByEnds(network.springs);
  return network;
}

SpringNetwork renumbered(const SpringNetwork& network, std::vector<uint32_t>* slot_of_node) {
  const std::vector<uint32_t> order = mortonOrder(network);
  std::vector<uint32_t> slot_of(network.positions_m.size(), std::numeric_limits<uint32_t>::max());
  const size_t slots = (order.size() + layout::kBrickSlots - 1) / layout::kBrickSlots * layout::kBrickSlots;
  SpringNetwork out;
  out.positions_m.assign(slots, Vector3d::Zero());
  out.masses_kg.resize(slots);
  for (uint32_t slot = 0; slot < order.size(); ++slot) {
    slot_of[order[slot]] = slot;
    out.positions_m[slot] = network.positions_m[order[slot]];
    out.masses_kg[slot] = network.masses_kg[order[slot]];
  }
  for (NetworkSpring spring : network.springs) {
    const uint32_t a = slot_of[spring.a], b = slot_of[spring.b];
    spring.a = std::min(a, b);
    spring.b = std::max(a, b);
    out.springs.push_back(spring);
  }
  sortByEnds(out.springs);
  for (const auto& t : network.triangles) out.triangles.push_back({slot_of[t[0]], slot_of[t[1]], slot_of[t[2]]});
  out.charts = network.charts;
  out.detail = network.detail;
  if (slot_of_node) *slot_of_node = std::move(slot_of);
  return out;
}

Lattice slotsOfNetwork(const SpringNetwork& network) {
  Lattice lattice;
  lattice.spacing_m = network.meanLength();
  const size_t slots = network.positions_m.size();
  assert(slots % layout::kBrickSlots == 0);
  lattice.bricks.resize(slots / layout::kBrickSlots);
  for (uint32_t b = 0; b < lattice.bricks.size(); ++b) {
    for (uint32_t& neighbor : lattice.bricks[b].neighbors) neighbor = b;
  }
  lattice.nodes.resize(slots);
  lattice.labels.resize(slots);
  lattice.cell_labels.resize(slots);
  for (uint32_t slot = 0; slot < slots; ++slot) {
    if (!(network.masses_kg[slot] > 0)) continue;
    lattice.active_slots.push_back(slot);
    lattice.labels[slot] = 1;
    lattice.nodes[slot].lo = 1u << layout::kMassShift;  // marks the slot as a node
  }
  for (const NetworkSpring& spring : network.springs) {
    ++lattice.nodes[spring.a].lo;  // the valence, see layout::kValenceMask
    ++lattice.nodes[spring.b].lo;
  }
  return lattice;
}

std::vector<uint32_t> adoptNetwork(const SpringNetwork& network, Body& body) {
  std::vector<uint32_t> slot_of_node;
  body.network = renumbered(network, &slot_of_node);
  body.lattice = slotsOfNetwork(*body.network);
  return slot_of_node;
}

}  // namespace viscera
