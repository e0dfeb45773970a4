// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/model/body/lattice.h"

#include <algorithm>

#include "viscera/math/error.h"

namespace viscera {

namespace {

constexpr int kEdge = static_cast<int>(layout::kBrickEdge);

uint64_t brickKey(const Vector3i& brick) {
  return static_cast<uint64_t>(brick.x()) | static_cast<uint64_t>(brick.y()) << 21 |
         static_cast<uint64_t>(brick.z()) << 42;
}

uint32_t slotInBrick(const Vector3i& node) {
  return static_cast<uint32_t>((node.x() % kEdge) + kEdge * ((node.y() % kEdge) + kEdge * (node.z() % kEdge)));
}

/// Returns the slot for integer coordinates, with or without a node there; -1 where there is no brick.
int64_t storedAt(const Lattice& lattice, const Vector3i& node) {
  if ((node.array() < 0).any() || (node.array() >= lattice.nodes_per_axis.array()).any()) return -1;
  const auto brick = lattice.brick_index.find(brickKey(node / kEdge));
  if (brick == lattice.brick_index.end()) return -1;
  return static_cast<int64_t>(brick->second) * layout::kBrickSlots + slotInBrick(node);
}

/// Returns corner c of a cell, c = 0..7, one bit per axis.
Vector3i corner(int c) {
  return {c & 1, (c >> 1) & 1, (c >> 2) & 1};
}

/// Calls visit(cell) for every filled cell.
template <class Visit>
void forEachCell(const Solid& solid, Visit visit) {
  for (int z = 0; z < solid.cells.z(); ++z)
    for (int y = 0; y < solid.cells.y(); ++y)
      for (int x = 0; x < solid.cells.x(); ++x)
        if (solid.labels[solid.index(x, y, z)]) visit(Vector3i(x, y, z));
}

void makeBricks(const Solid& solid, Lattice& lattice) {
  const Vector3i per_axis = (lattice.nodes_per_axis.array() + kEdge - 1) / kEdge;
  std::vector<bool> wanted(static_cast<size_t>(per_axis.cast<int64_t>().prod()));
  const auto flat = [&](const Vector3i& b) {
    return static_cast<size_t>(b.x()) +
           static_cast<size_t>(per_axis.x()) * (b.y() + static_cast<size_t>(per_axis.y()) * b.z());
  };
  forEachCell(solid, [&](const Vector3i& cell) {
    for (int c = 0; c < 8; ++c) wanted[flat((cell + corner(c)) / kEdge)] = true;
  });
  for (int z = 0; z < per_axis.z(); ++z)
    for (int y = 0; y < per_axis.y(); ++y)
      for (int x = 0; x < per_axis.x(); ++x) {
        if (!wanted[flat({x, y, z})]) continue;
        lattice.brick_index[brickKey({x, y, z})] = static_cast<uint32_t>(lattice.bricks.size());
        layout::Brick brick{};
        brick.coord_x = x;
        brick.coord_y = y;
        brick.coord_z = z;
        lattice.bricks.push_back(brick);
      }
}

void linkBricks(Lattice& lattice) {
  for (uint32_t b = 0; b < lattice.bricks.size(); ++b) {
    layout::Brick& brick = lattice.bricks[b];
    for (int d = 0; d < 27; ++d) {
      const Vector3i at =
          Vector3i(brick.coord_x, brick.coord_y, brick.coord_z) + Vector3i(d % 3, d / 3 % 3, d / 9) - Vector3i::Ones();
      const auto found = (at.array() < 0).any() ? lattice.brick_index.end() : lattice.brick_index.find(brickKey(at));
      brick.neighbors[d] = found == lattice.brick_index.end() ? b : found->second;
    }
  }
}

/// Adds one solid cell: a quarter to its 12 edges, a half to its 12 face diagonals, an eighth to its 8 nodes.
/// @param fill  null where the cell is full
void addCell(const Solid& solid, const Vector3i& cell, const CellFill* fill, Lattice& lattice) {
  const uint16_t label = solid.label(cell.x(), cell.y(), cell.z());
  const uint32_t lowest = static_cast<uint32_t>(storedAt(lattice, cell));
  lattice.cell_labels[lowest] = label;
  if (fill != nullptr) {
    lattice.fills.push_back(*fill);
    lattice.cell_fills[lowest] = static_cast<uint32_t>(lattice.fills.size());
  }
  lattice.nodes[lowest].lo |= layout::kCellBit;
  for (int a = 0; a < 8; ++a) {
    const Vector3i node = cell + corner(a);
    const uint32_t slot = static_cast<uint32_t>(storedAt(lattice, node));
    layout::NodeBits& bits = lattice.nodes[slot];
    bits.lo += 1u << layout::kMassShift;
    if (!lattice.labels[slot]) lattice.labels[slot] = label;
    for (int b = 0; b < 8; ++b) {
      const int spring = springIndex(corner(b) - corner(a));
      if (spring < 0) continue;  // the same node, or the body diagonal
      const uint32_t s = static_cast<uint32_t>(spring);
      setSpringCount(bits, s, springCount(bits, s) + 1);
    }
  }
}

void setShared(const Solid& solid, Lattice& lattice) {
  const auto nx = static_cast<size_t>(solid.cells.x()), ny = static_cast<size_t>(solid.cells.y());
  for (const PartFill& part : solid.shared) {
    if (solid.labels[part.cell] == 0) continue;
    const Vector3i cell(static_cast<int>(part.cell % nx), static_cast<int>(part.cell / nx % ny),
                        static_cast<int>(part.cell / nx / ny));
    lattice.shared.push_back({static_cast<size_t>(storedAt(lattice, cell)), part.label, part.fill});
  }
  std::stable_sort(lattice.shared.begin(), lattice.shared.end(),
                   [](const PartFill& a, const PartFill& b) { return a.cell < b.cell; });
}

void setDepths(const Solid& solid, Lattice& lattice) {
  const auto deepest = static_cast<float>(lattice.spacing_m);
  lattice.depth_m.assign(lattice.nodes.size(), deepest);
  lattice.offset_to_surface_m.assign(lattice.nodes.size(), Eigen::Vector3f::Zero());
  for (const NodeDepth& n : solid.depths) {
    const auto slot = static_cast<size_t>(storedAt(lattice, n.node));
    lattice.depth_m[slot] = std::min(n.depth_m, deepest);
    lattice.offset_to_surface_m[slot] = n.offset_m;
  }
}

/// Applies VR05's uniform weights: every spring that exists and every node counts in full.
void makeUniform(Lattice& lattice) {
  for (uint32_t slot : lattice.active_slots) {
    layout::NodeBits& bits = lattice.nodes[slot];
    for (uint32_t s = 0; s < layout::kSpringsPerNode; ++s) {
      if (springCount(bits, s)) setSpringCount(bits, s, isAxial(s) ? 4 : 2);
    }
    bits.lo = (bits.lo & ~(15u << layout::kMassShift)) | 8u << layout::kMassShift;
  }
}

}  // namespace

int64_t Lattice::slotAt(const Vector3i& node) const {
  const int64_t slot = storedAt(*this, node);
  return slot >= 0 && massEighths(nodes[static_cast<size_t>(slot)]) ? slot : -1;
}

int64_t Lattice::neighborSlot(uint32_t slot, uint32_t spring) const {
  const auto& o = kNeighborOffsets[spring];
  return slotAt(nodeAt(slot) + Vector3i(o[0], o[1], o[2]));
}

Vector3i Lattice::nodeAt(uint32_t slot) const {
  const layout::Brick& brick = bricks[slot / layout::kBrickSlots];
  const int local = static_cast<int>(slot % layout::kBrickSlots);
  return Vector3i(brick.coord_x, brick.coord_y, brick.coord_z) * kEdge +
         Vector3i(local % kEdge, local / kEdge % kEdge, local / (kEdge * kEdge));
}

Vector3d Lattice::restPosition(uint32_t slot) const {
  return origin_m + spacing_m * nodeAt(slot).cast<double>();
}

size_t Lattice::springs() const {
  size_t ends = 0;
  for (uint32_t slot : active_slots)
    for (uint32_t s = 0; s < layout::kSpringsPerNode; ++s) ends += springCount(nodes[slot], s) ? 1 : 0;
  return ends / 2;
}

Lattice buildLattice(const Solid& solid, Weights weights) {
  Lattice lattice;
  lattice.spacing_m = solid.spacing_m;
  lattice.origin_m = solid.origin_m;
  lattice.nodes_per_axis = solid.cells.array() + 1;
  lattice.part_names = solid.part_names;
  makeBricks(solid, lattice);
  if (lattice.bricks.empty()) throw LatticeError("the solid has no filled cell: nothing to build a lattice from");
  linkBricks(lattice);
  lattice.nodes.resize(lattice.bricks.size() * layout::kBrickSlots);
  lattice.labels.resize(lattice.nodes.size());
  lattice.cell_labels.resize(lattice.nodes.size());
  if (!solid.partial.empty()) lattice.cell_fills.resize(lattice.nodes.size());
  size_t next = 0;  // index of the next partial cell, in the same order
  forEachCell(solid, [&](const Vector3i& cell) {
    const bool partial =
        next < solid.partial.size() && solid.partial[next].cell == solid.index(cell.x(), cell.y(), cell.z());
    addCell(solid, cell, partial ? &solid.partial[next++].fill : nullptr, lattice);
  });
  for (uint32_t slot = 0; slot < lattice.nodes.size(); ++slot) {
    if (massEighths(lattice.nodes[slot])) lattice.active_slots.push_back(slot);
  }
  setShared(solid, lattice);
  if (!solid.partial.empty()) setDepths(solid, lattice);
  if (weights == Weights::kPaper) makeUniform(lattice);
  return lattice;
}

}  // namespace viscera
