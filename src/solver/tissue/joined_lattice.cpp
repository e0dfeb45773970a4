// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/tissue/joined_lattice.h"

#include <algorithm>
#include <cmath>

#include "layout/surface_offsets.h"
#include "viscera/model/body/cell_laminates.h"
#include "viscera/model/body/wall_cells.h"

namespace viscera {

namespace {

void append(std::vector<float>& to, const std::vector<float>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

}  // namespace

std::vector<uint32_t> activeSlots(const Model& model) {
  std::vector<uint32_t> out;
  out.reserve(model.activeNodes());
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    for (uint32_t slot : model.bodies[b].lattice.active_slots) out.push_back(model.slotOffset(b) + slot);
  }
  return out;
}

std::vector<uint32_t> movingSlots(const Model& model) {
  std::vector<uint32_t> out = activeSlots(model);
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    for (const RowGhost& ghost : model.bodies[b].lattice.ghosts) out.push_back(model.slotOffset(b) + ghost.slot);
  }
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<uint32_t> cellSlots(const Model& model) {
  std::vector<uint32_t> out;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Lattice& lattice = model.bodies[b].lattice;
    for (uint32_t slot : lattice.active_slots) {
      if (lattice.nodes[slot].lo & layout::kCellBit) out.push_back(model.slotOffset(b) + slot);
    }
  }
  return out;
}

std::vector<layout::Brick> allBricks(const Model& model) {
  std::vector<layout::Brick> out;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const uint32_t first = static_cast<uint32_t>(out.size());
    for (layout::Brick brick : model.bodies[b].lattice.bricks) {
      brick.body = static_cast<uint32_t>(b);
      for (uint32_t& neighbor : brick.neighbors) neighbor += first;
      out.push_back(brick);
    }
  }
  return out;
}

std::vector<layout::NodeBits> allNodes(const Model& model) {
  std::vector<layout::NodeBits> out;
  out.reserve(model.slots());
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const bool of_law = model.bodies[b].material.law == Law::kNeoHookean;
    for (layout::NodeBits bits : model.bodies[b].lattice.nodes) {
      bits.hi |= static_cast<uint32_t>(b) << layout::kBodyShift;
      if (of_law && bits.lo & layout::kCellBit) bits.lo |= layout::kLawCellBit;
      out.push_back(bits);
    }
  }
  return out;
}

Strengths allStrengths(const Model& model) {
  Strengths out;
  for (const Body& body : model.bodies) {
    const Strengths table = strengths(body);
    append(out.spring_n_per_m, table.spring_n_per_m);
    append(out.mass_kg, table.mass_kg);
    append(out.bulk_j, table.bulk_j);
    append(out.rigidity_j, table.rigidity_j);
  }
  return out;
}

namespace {

/// Returns a node's word as defined in surface_offsets.h.
uint32_t packedOffset(const Lattice& lattice, uint32_t slot) {
  const Vector3d cells = lattice.offset_to_surface_m[slot].cast<double>() / lattice.spacing_m;
  uint32_t word = 0;
  bool any = false;
  for (int axis = 0; axis < 3; ++axis) {
    const long steps =
        std::clamp(std::lround(cells[axis] / layout::kOffsetStep), 1l - layout::kOffsetZero, layout::kOffsetZero - 1l);
    word |= static_cast<uint32_t>(steps + layout::kOffsetZero) << (layout::kOffsetBits * static_cast<uint32_t>(axis));
    if (steps == 0) continue;
    any = true;
    Vector3i beside = lattice.nodeAt(slot);
    beside[axis] += steps > 0 ? 1 : -1;
    if (lattice.slotAt(beside) >= 0) word |= layout::kOffsetEdgeBit << static_cast<uint32_t>(axis);
  }
  return any ? word : 0;
}

/// Returns a number per slot for nodes of bodies with partially filled cells; 0 elsewhere, empty without such bodies.
/// @param numberOf  lattice, its slot -> number
template <class Number, class NumberOf>
std::vector<Number> atSurface(const Model& model, NumberOf numberOf) {
  std::vector<Number> out;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Lattice& lattice = model.bodies[b].lattice;
    if (lattice.depth_m.empty()) continue;
    out.resize(model.slots(), 0);
    for (const uint32_t slot : lattice.active_slots) out[model.slotOffset(b) + slot] = numberOf(lattice, slot);
  }
  return out;
}

void addStresses(const Model& model, JoinedMoments& out) {
  out.stress_of_cell.resize(out.of_cell.size());
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    for (uint32_t slot = 0; slot < body.prestress.size(); ++slot) {
      if (body.lattice.cell_labels[slot] == 0) continue;
      const std::array<float, 6>& s = body.prestress[slot];
      out.stress_of_cell[model.slotOffset(b) + slot] = static_cast<uint32_t>(out.vectors.size());
      out.vectors.push_back({s[0], s[1], s[2], 0});
      out.vectors.push_back({s[3], s[4], s[5], 0});
    }
  }
}

void addLaminate(const CellLaminate& cell, uint32_t slot, JoinedMoments& out) {
  const auto packed = [&](double x, double y, double z, double w) {
    out.vectors.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), static_cast<float>(w)});
  };
  out.vectors[kVectorsPerFill * out.of_cell[slot]].w = static_cast<float>(out.vectors.size());
  packed(cell.normal.x(), cell.normal.y(), cell.normal.z(), cell.share_a);
  packed(cell.rigidity_a, cell.rigidity_b(), cell.bulk_a, cell.bulk_b);
}

void addWall(const WallCell& cell, uint32_t slot, JoinedMoments& out) {
  out.vectors[kVectorsPerFill * out.of_cell[slot] + 1].w = static_cast<float>(out.vectors.size());
  const Eigen::Vector3f normal = cell.normal.cast<float>();
  out.vectors.push_back({normal.x(), normal.y(), normal.z(), static_cast<float>(cell.rows)});
  out.vectors.push_back({static_cast<float>(cell.variation), 0, 0, 0});
}

}  // namespace

std::vector<float> surfaceDepths(const Model& model) {
  return atSurface<float>(model, [](const Lattice& lattice, uint32_t slot) {
    return lattice.depth_m[slot] < 0.5 * lattice.spacing_m ? lattice.depth_m[slot] : 0.0f;
  });
}

float edgeReach(const Model& model) {
  constexpr double kStretch = 1.41;  // farther ends have small shares
  double longest_m = 0;
  for (const Body& body : model.bodies) {
    if (!body.network) {
      longest_m = std::max(longest_m, std::sqrt(2.0) * body.lattice.spacing_m);
      continue;
    }
    for (const NetworkSpring& spring : body.network->springs)
      longest_m = std::max(longest_m, spring.against_bending ? 0 : spring.rest_length_m);
  }
  return static_cast<float>(kStretch * longest_m);
}

std::vector<uint32_t> surfaceOffsets(const Model& model) {
  return atSurface<uint32_t>(model, packedOffset);
}

bool hasCellPrestress(const Model& model) {
  return std::any_of(model.bodies.begin(), model.bodies.end(),
                     [](const Body& body) { return !body.prestress.empty(); });
}

bool hasWalls(const Model& model) {
  return std::any_of(model.bodies.begin(), model.bodies.end(),
                     [](const Body& body) { return !wallCells(body).empty(); });
}

bool hasLaminates(const Model& model) {
  return std::any_of(model.bodies.begin(), model.bodies.end(),
                     [](const Body& body) { return !cellLaminates(body).cells.empty(); });
}

JoinedMoments allMoments(const Model& model) {
  JoinedMoments out;
  std::vector<std::vector<WallCell>> walls;
  out.add(CellFill{});
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Lattice& lattice = model.bodies[b].lattice;
    const auto before = static_cast<uint32_t>(out.vectors.size() / kVectorsPerFill - 1);
    const CellMoments moments = cellMoments(model.bodies[b]);
    for (const uint32_t fill : moments.of_cell) out.of_cell.push_back(fill == 0 ? 0 : before + fill);
    out.of_cell.resize(model.slotOffset(b) + lattice.nodes.size());
    for (const CellFill& fill : moments.fills) out.add(fill);
    walls.push_back(wallCells(model.bodies[b]));
    for (const WallCell& cell : walls.back()) {  // full cells have moments of their own there
      uint32_t& which = out.of_cell[model.slotOffset(b) + cell.cell];
      if (which != 0) continue;
      which = static_cast<uint32_t>(out.vectors.size() / kVectorsPerFill);
      out.add(CellFill{});
    }
  }
  if (hasCellPrestress(model)) addStresses(model, out);
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    for (const CellLaminate& cell : cellLaminates(model.bodies[b]).cells)
      addLaminate(cell, model.slotOffset(b) + cell.cell, out);
    for (const WallCell& cell : walls[b]) addWall(cell, model.slotOffset(b) + cell.cell, out);
  }
  return out;
}

void JoinedMoments::add(const CellFill& fill) {
  const auto packed = [&](double x, double y, double z) {
    vectors.push_back({static_cast<float>(x / fill.share), static_cast<float>(y / fill.share),
                       static_cast<float>(z / fill.share), 0});
  };
  const Eigen::Matrix3d& m = fill.second;
  packed(fill.first.x(), fill.first.y(), fill.first.z());
  packed(m(0, 0), m(1, 1), m(2, 2));
  packed(m(1, 2), m(2, 0), m(0, 1));
}

}  // namespace viscera
