// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <random>
#include <set>

#include "viscera/model/model.h"

namespace viscera::test {

/// Returns a body of a box of whole cells, its lower corner at the origin.
inline Body boxBody(const Vector3i& cells, double spacing_m, Weights weights = Weights::kCell) {
  Body body;
  body.name = "box";
  Solid solid;
  solid.spacing_m = spacing_m;
  solid.cells = cells;
  solid.labels.assign(static_cast<size_t>(cells.prod()), 1);
  solid.part_names = {"box"};
  body.lattice = buildLattice(solid, weights);
  return body;
}

/// Returns the body with cells of the neo-Hookean law.
inline Body ofLaw(Body body, double poisson_ratio = 0.3) {
  body.material.law = Law::kNeoHookean;
  body.material.poisson_ratio = poisson_ratio;
  return body;
}

/// Returns a body with the cells of a grid that are partly tissue where `inside(point in cells)` holds, sampled at
/// kSamples points per edge. Cells with less than a hundredth are left out. They obey the neo-Hookean law, as all
/// partially filled cells do.
template <class Inside>
Body momentBody(const Vector3i& cells, double spacing_m, Inside inside) {
  constexpr int kSamples = 6;
  constexpr double kLeast = 0.01;
  Body body;
  body.name = "part";
  body.material.law = Law::kNeoHookean;
  Solid solid;
  solid.spacing_m = spacing_m;
  solid.cells = cells;
  solid.labels.assign(static_cast<size_t>(cells.prod()), 0);
  solid.part_names = {"part"};
  for (int z = 0; z < cells.z(); ++z)
    for (int y = 0; y < cells.y(); ++y)
      for (int x = 0; x < cells.x(); ++x) {
        CellFill fill{0, Vector3d::Zero(), Eigen::Matrix3d::Zero()};
        constexpr double kPart = 1.0 / (kSamples * kSamples * kSamples);
        for (int i = 0; i < kSamples * kSamples * kSamples; ++i) {
          const Vector3d p =
              (Vector3d(i % kSamples, i / kSamples % kSamples, i / kSamples / kSamples).array() + 0.5) / kSamples - 0.5;
          if (!inside(Vector3d(x, y, z).array() + 0.5 + p.array())) continue;
          fill.share += kPart;
          fill.first += kPart * p;
          fill.second += kPart * (p * p.transpose() +
                                  Eigen::Matrix3d(Vector3d::Constant(1.0 / (12 * kSamples * kSamples)).asDiagonal()));
        }
        if (fill.share < kLeast) continue;
        const size_t cell = solid.index(x, y, z);
        solid.labels[cell] = 1;
        if (fill.share < 1 - kPart / 2) solid.partial.push_back({cell, fill});
      }
  body.lattice = buildLattice(solid, Weights::kCell);
  return body;
}

/// Returns a lattice of exactly `count` nodes: a random tree of adjacent nodes with random counts on every spring
/// between two of them, the same from both ends. A solid's cells cannot give sizes such as 1 or 63.
inline Body blobBody(size_t count, double spacing_m, uint32_t seed) {
  std::mt19937 random(seed);
  const int extent = std::max(4, static_cast<int>(2 * std::cbrt(static_cast<double>(count))));
  const Vector3i middle = Vector3i::Constant(extent / 2);
  const auto key = [](const Vector3i& n) { return std::array<int, 3>{n.x(), n.y(), n.z()}; };
  std::set<std::array<int, 3>> wanted = {key(middle)};
  std::vector<Vector3i> grown = {middle};
  while (grown.size() < count) {
    const auto& o = kNeighborOffsets[random() % layout::kSpringsPerNode];
    const Vector3i next = grown[random() % grown.size()] + Vector3i(o[0], o[1], o[2]);
    if ((next.array() < 0).any() || (next.array() > extent).any() || !wanted.insert(key(next)).second) continue;
    grown.push_back(next);
  }
  Body body = boxBody(Vector3i::Constant(extent), spacing_m);
  Lattice& lattice = body.lattice;
  lattice.active_slots.clear();
  for (uint32_t slot = 0; slot < lattice.nodes.size(); ++slot) {
    layout::NodeBits& bits = lattice.nodes[slot];
    const bool keep = wanted.count(key(lattice.nodeAt(slot))) > 0;
    bits = {keep ? (1u + static_cast<uint32_t>(random() % 8)) << layout::kMassShift : 0u, 0u};
    if (keep) lattice.active_slots.push_back(slot);
  }
  for (uint32_t slot : lattice.active_slots) {
    for (uint32_t s = 0; s < layout::kSpringsPerNode; s += 2) {
      const int64_t other = lattice.neighborSlot(slot, s);
      if (other < 0) continue;
      const uint32_t strength = isAxial(s) ? 1 + random() % 4 : 1 + random() % 2;
      setSpringCount(lattice.nodes[slot], s, strength);
      setSpringCount(lattice.nodes[static_cast<size_t>(other)], oppositeSpring(s), strength);
    }
  }
  return body;
}

/// Returns a chain of nodes along z with axial springs of four quarters (stiffness k) and nodes of eight eighths (mass
/// m).
inline Body chainBody(int count, double spacing_m) {
  Body body = boxBody({1, 1, count - 1}, spacing_m);
  Lattice& lattice = body.lattice;
  lattice.active_slots.clear();
  for (uint32_t slot = 0; slot < lattice.nodes.size(); ++slot) {
    const Vector3i n = lattice.nodeAt(slot);
    layout::NodeBits& bits = lattice.nodes[slot];
    const bool keep = n.x() == 0 && n.y() == 0 && massEighths(bits) > 0;
    bits = {keep ? 8u << layout::kMassShift : 0u, 0u};
    if (!keep) continue;
    lattice.active_slots.push_back(slot);
    if (n.z() + 1 < count) setSpringCount(bits, 4, 4);
    if (n.z() > 0) setSpringCount(bits, 5, 4);
  }
  return body;
}

/// Removes the springs between two layers of nodes of a box, `at` and the next along `axis`, as a cut does. Affects
/// nodes from `first` on along the following axis.
inline void slit(Body& body, int axis, int at, int first) {
  Lattice& lattice = body.lattice;
  const int along = (axis + 1) % 3;
  for (const uint32_t slot : lattice.active_slots) {
    const Vector3i node = lattice.nodeAt(slot);
    if (node[axis] == at && node[along] >= first - 1) lattice.nodes[slot].lo &= ~layout::kCellBit;
    for (uint32_t s = 0; s < layout::kSpringsPerNode; ++s) {
      const auto& offset = kNeighborOffsets[s];
      const int d = offset[static_cast<size_t>(axis)];
      const bool across = (node[axis] == at && d > 0) || (node[axis] == at + 1 && d < 0);
      const int nearest = std::max(node[along], node[along] + offset[static_cast<size_t>(along)]);
      if (across && nearest >= first) setSpringCount(lattice.nodes[slot], s, 0);
    }
  }
}

inline Model modelOf(std::vector<Body> bodies) {
  Model model;
  model.bodies = std::move(bodies);
  return model;
}

/// Node counts around the size of a work group, and one that fills many.
constexpr size_t kSizes[] = {1, 63, 64, 65, 1234};

/// Returns the same body of two materials: `part` is beyond a plane. Cells are sampled, regardless of their share of
/// tissue. @param normal  of the plane   @param at  of the plane along it, in cells from the lattice's first node
inline Body twoMaterials(Body body, const Vector3d& normal, double at, const PartConfig& part) {
  constexpr int kSamples = 12;
  const Vector3d n = normal.normalized();
  Lattice& lattice = body.lattice;
  lattice.part_names = {"rest", part.part};
  body.parts = {part};
  for (uint32_t slot = 0; slot < lattice.nodes.size(); ++slot) {
    if (!lattice.cell_labels[slot]) continue;
    CellFill fills[2];
    for (CellFill& fill : fills) fill = {0, Vector3d::Zero(), Eigen::Matrix3d::Zero()};
    for (int i = 0; i < kSamples * kSamples * kSamples; ++i) {
      const Vector3d p =
          (Vector3d(i % kSamples, i / kSamples % kSamples, i / kSamples / kSamples).array() + 0.5) / kSamples - 0.5;
      const Vector3d x = lattice.nodeAt(slot).cast<double>() + Vector3d::Constant(0.5) + p;
      CellFill& fill = fills[x.dot(n) > at ? 1 : 0];
      fill.share += std::pow(kSamples, -3);
      fill.first += std::pow(kSamples, -3) * p;
      fill.second +=
          std::pow(kSamples, -3) * (p * p.transpose() + Eigen::Matrix3d::Identity() * std::pow(kSamples, -2) / 12);
    }
    lattice.cell_labels[slot] = fills[1].share > 0.5 ? 2 : 1;
    if (fills[0].share < 1e-9 || fills[1].share < 1e-9) continue;
    for (uint16_t label = 1; label <= 2; ++label) lattice.shared.push_back({slot, label, fills[label - 1]});
  }
  return body;
}

}  // namespace viscera::test
