// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/tissue/joined_lattice.h"

#include <algorithm>
#include <cmath>

#include "layout/surface_ways.h"

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
    out.rigidity_j.resize(out.bulk_j.size());
  }
  return out;
}

namespace {

/// A word of surface_ways.h.
uint32_t packedWay(const Lattice& lattice, uint32_t slot) {
  const Vector3d cells = lattice.way_to_surface_m[slot].cast<double>() / lattice.spacing_m;
  uint32_t word = 0;
  bool any = false;
  for (int axis = 0; axis < 3; ++axis) {
    const long steps =
        std::clamp(std::lround(cells[axis] / layout::kWayStep), 1l - layout::kWayZero, layout::kWayZero - 1l);
    word |= static_cast<uint32_t>(steps + layout::kWayZero) << (layout::kWayBits * static_cast<uint32_t>(axis));
    if (steps == 0) continue;
    any = true;
    Vector3i beside = lattice.nodeAt(slot);
    beside[axis] += steps > 0 ? 1 : -1;
    if (lattice.slotAt(beside) >= 0) word |= layout::kWayEdgeBit << static_cast<uint32_t>(axis);
  }
  return any ? word : 0;
}

/// A number per slot, of nodes of bodies with cells that are tissue in part; 0 elsewhere, empty without such bodies.
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

std::vector<uint32_t> surfaceWays(const Model& model) {
  return atSurface<uint32_t>(model, packedWay);
}

bool hasBends(const Model& model) {
  return std::any_of(model.bodies.begin(), model.bodies.end(),
                     [](const Body& body) { return body.material.thin_walls && !body.lattice.fills.empty(); });
}

JoinedMoments allMoments(const Model& model) {
  JoinedMoments out;
  out.add(CellFill{});
  std::vector<CellMoments> moments;
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    const Lattice& lattice = model.bodies[b].lattice;
    const auto before = static_cast<uint32_t>(out.vectors.size() / kVectorsPerFill - 1);
    moments.push_back(cellMoments(model.bodies[b]));
    for (const uint32_t fill : moments[b].of_cell) out.of_cell.push_back(fill == 0 ? 0 : before + fill);
    out.of_cell.resize(model.slotOffset(b) + lattice.nodes.size());
    for (const CellFill& fill : moments[b].fills) out.add(fill);
  }
  if (!hasBends(model)) return out;
  constexpr size_t kStride = layout::kBendVectors;
  out.vectors.resize((out.vectors.size() + kStride - 1) / kStride * kStride);
  out.bend_of_cell.resize(out.of_cell.size());
  for (size_t b = 0; b < model.bodies.size(); ++b) {
    if (moments[b].bends.empty()) continue;
    const Strengths table = strengths(model.bodies[b]);
    for (const CellBend& bend : moments[b].bends) {
      const CellFill& fill = moments[b].fills[moments[b].of_cell[bend.cell] - 1];
      const double ratio =
          static_cast<double>(table.bulk_j[bend.cell]) / static_cast<double>(table.rigidity_j[bend.cell]);
      out.add(model.slotOffset(b) + bend.cell, {1, fill.first / fill.share, fill.second / fill.share}, 1 + ratio, bend);
    }
  }
  return out;
}

void JoinedMoments::add(uint32_t slot, const CellFill& over_share, double lambda_over_mu, const CellBend& bend) {
  const CellBending with = bendingOf(over_share, lambda_over_mu, bend.missing);
  const CellBending without = bendingOf(over_share, lambda_over_mu, missingAlone(lambda_over_mu));
  bend_of_cell[slot] = static_cast<uint32_t>(vectors.size() / layout::kBendVectors);
  std::vector<float> numbers;
  for (Eigen::Index row = 0; row < 9; ++row) {
    for (Eigen::Index column = row; column < 9; ++column)
      numbers.push_back(static_cast<float>(with.bends(row, column) - without.bends(row, column)));
  }
  for (Eigen::Index row = 0; row < 9; ++row) {
    for (Eigen::Index column = 0; column < 6; ++column)
      numbers.push_back(static_cast<float>(with.strains(row, column) - without.strains(row, column)));
  }
  numbers.resize(4 * layout::kBendVectors);
  for (size_t i = 0; i < numbers.size(); i += 4)
    vectors.push_back({numbers[i], numbers[i + 1], numbers[i + 2], numbers[i + 3]});
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
