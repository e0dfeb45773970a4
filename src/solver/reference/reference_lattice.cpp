// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/reference/reference_lattice.h"

#include <algorithm>

#include "solver/tissue/joined_lattice.h"
#include "viscera/model/body/cell_laminates.h"

namespace viscera {

namespace {

constexpr float kLeastFraction =
    1.0f / (1 << 24);                 ///< share of a spring's length at which a cut is recorded: 0 means whole
constexpr double kLeastShare = 0.02;  ///< the same of a spring of a lattice (shaders/solver/tools/blade.glsl)
constexpr std::array<int, 8> kNoCells = {-1, -1, -1, -1, -1, -1, -1, -1};

Vector3i cornerOffset(size_t corner) {
  return {static_cast<int>(corner & 1u), static_cast<int>((corner >> 1) & 1u), static_cast<int>((corner >> 2) & 1u)};
}

}  // namespace

ReferenceLattice::ReferenceLattice(const Model& model)
    : axial_cut(3 * model.slots()),
      cut_sides(model.slots(), Vector3d::Zero()),
      predicts_(predictsSprings(model)),
      rest_m_(model.slots(), Vector3d::Zero()),
      surface_depth_m_(surfaceDepths(model)),
      position_(model.slots(), -1),
      around_(model.slots(), kNoCells) {
  const double dt_safe_s = safeTimeStep(model);
  for (size_t b = 0; b < model.bodies.size(); ++b) addBody(model, b, dt_safe_s);
  for (size_t i = 0; i < active.size(); ++i) position_[active[i]] = static_cast<int>(i);
  linkWalls();
}

void ReferenceLattice::addBody(const Model& model, size_t b, double dt_safe_s) {
  const Body& body = model.bodies[b];
  const Lattice& lattice = body.lattice;
  const uint32_t first = model.slotOffset(b);
  first_.push_back(first);
  has_valences_.push_back(!body.hasCells());
  params_.push_back(bodyParams(body, dt_safe_s));
  strengths_.push_back(isHeterogeneous(body) ? strengths(body) : Strengths{});
  moments_ = cellMoments(body);
  laminates_.clear();
  for (const CellLaminate& cell : cellLaminates(body).cells) laminates_[cell.cell] = lawLaminateOf(cell);
  walls_.clear();
  for (const WallCell& cell : wallCells(body)) walls_[cell.cell] = cell;
  if (body.network) strengths_[b].mass_kg.assign(body.network->masses_kg.begin(), body.network->masses_kg.end());
  const bool of_law = body.material.law == Law::kNeoHookean;
  for (layout::NodeBits bits : lattice.nodes) {
    bits.hi |= static_cast<uint32_t>(b) << layout::kBodyShift;
    if (of_law && bits.lo & layout::kCellBit) bits.lo |= layout::kLawCellBit;
    nodes.push_back(bits);
  }
  for (uint32_t slot : lattice.active_slots) {
    active.push_back(first + slot);
    rest_m_[first + slot] = viscera::restPosition(body, slot);
    if (!has_valences_[b] && lattice.nodes[slot].lo & layout::kCellBit) addCell(body, b, slot);
    if (!lattice.offset_to_surface_m.empty()) addOffset(lattice, first, slot);
  }
  if (body.network) {
    addLinks(*body.network, first);
  } else {
    addLatticeSprings(lattice, first);
  }
  for (const RowGhost& ghost : lattice.ghosts) {
    active.push_back(first + ghost.slot);
    rest_m_[first + ghost.slot] = viscera::restPosition(body, ghost.slot);
    neighbors_[starts_[first + ghost.fixed] + ghost.spring].slot = first + ghost.slot;
    neighbors_[starts_[first + ghost.slot] + oppositeSpring(ghost.spring)].slot = first + ghost.fixed;
  }
}

void ReferenceLattice::addLatticeSprings(const Lattice& lattice, uint32_t first) {
  for (uint32_t slot = 0; slot < lattice.nodes.size(); ++slot) {
    for (uint32_t s = 0; s < layout::kSpringsPerNode; ++s) {
      const auto& o = kNeighborOffsets[s];
      const Vector3d offset = lattice.spacing_m * Vector3d(o[0], o[1], o[2]);
      const int64_t other = lattice.neighborSlot(slot, s);
      const uint32_t far = other < 0 ? 0u : first + static_cast<uint32_t>(other);
      neighbors_.push_back({far, offset, offset.norm(), s % 2 == 0, s, -1, 0});
    }
    starts_.push_back(static_cast<uint32_t>(neighbors_.size()));
  }
}

void ReferenceLattice::addLinks(const SpringNetwork& network, uint32_t first) {
  const NetworkLinks links = linksOf(network);
  const size_t base = neighbors_.size();
  neighbors_.resize(base + links.links.size());
  for (size_t i = 0; i < network.springs.size(); ++i) {
    const layout::SpringEnds& ends = links.ends[i];
    const Vector3d offset = network.positions_m[ends.b] - network.positions_m[ends.a];
    const double rest = network.springs[i].rest_length_m;
    const auto number = static_cast<int64_t>(spring_cut.size());
    const layout::Link &a = links.links[ends.link_a], &b = links.links[ends.link_b];
    neighbors_[base + ends.link_a] = {first + a.far, offset, rest, true, a.lattice_spring, number, a.stiffness};
    neighbors_[base + ends.link_b] = {first + b.far, -offset, rest, false, b.lattice_spring, number, b.stiffness};
    spring_cut.push_back(0);
  }
  for (size_t slot = 0; slot + 1 < links.starts.size(); ++slot) {
    starts_.push_back(static_cast<uint32_t>(base) + links.starts[slot + 1]);
  }
}

void ReferenceLattice::addOffset(const Lattice& lattice, uint32_t first, uint32_t local) {
  SurfaceOffset offset{lattice.offset_to_surface_m[local].cast<double>(), lattice.spacing_m, {-1, -1, -1}};
  if (offset.offset_m.isZero()) return;
  for (int axis = 0; axis < 3; ++axis) {
    if (offset.offset_m[axis] == 0) continue;
    const Vector3i side = (offset.offset_m[axis] > 0 ? 1 : -1) * Vector3i::Unit(axis);
    const int64_t other = lattice.slotAt(lattice.nodeAt(local) + side);
    if (other >= 0) offset.to[static_cast<size_t>(axis)] = first + other;
  }
  offsets_[first + local] = offset;
}

Vector3d ReferenceLattice::offsetToSurface(const Field& u_m, uint32_t slot) const {
  const auto known = offsets_.find(slot);
  if (known == offsets_.end()) return Vector3d::Zero();
  const SurfaceOffset& offset = known->second;
  Vector3d out = offset.offset_m;
  for (int axis = 0; axis < 3; ++axis) {
    const int64_t other = offset.to[static_cast<size_t>(axis)];
    if (other < 0) continue;
    const Vector3d change = u_m[static_cast<size_t>(other)] - u_m[slot];
    if (change.norm() < offset.spacing_m) out += std::abs(offset.offset_m[axis]) / offset.spacing_m * change;
  }
  return out;
}

void ReferenceLattice::addCell(const Body& body, size_t b, uint32_t local) {
  const Lattice& lattice = body.lattice;
  const uint32_t first = first_[b];
  Cell cell{{}, lattice.spacing_m, {}};
  const Vector3i lowest = lattice.nodeAt(local);
  for (size_t c = 0; c < 8; ++c) {
    cell.corners[c] = first + static_cast<uint32_t>(lattice.slotAt(lowest + cornerOffset(c)));
    around_[cell.corners[c]][c] = static_cast<int>(cells_.size());
  }
  if (body.material.law == Law::kNeoHookean) {
    cell.law.stiffening = static_cast<double>(params_[b].stiffening);
    const Strengths& table = strengths_[b];
    cell.law.rigidity_j = table.rigidity_j.empty() ? params_[b].rigidity_j : table.rigidity_j[local];
    cell.law.bulk_j = table.bulk_j.empty() ? params_[b].bulk_j : table.bulk_j[local];
    const uint32_t which = moments_.of_cell.empty() ? 0 : moments_.of_cell[local];
    const CellFill fill = which == 0 ? CellFill{} : moments_.fills[which - 1];
    cell.law.fill = {1, fill.first / fill.share, fill.second / fill.share};
    if (!body.prestress.empty()) {
      const std::array<float, 6>& s = body.prestress[local];
      cell.law.prestress << s[0], s[5], s[4], s[5], s[1], s[3], s[4], s[3], s[2];
    }
    const auto laminate = laminates_.find(local);
    if (laminate != laminates_.end()) cell.law.laminate = laminate->second;
    const auto wall = walls_.find(local);
    if (wall != walls_.end()) addWall(wall->second, cell);
  }
  cells_.push_back(cell);
}

double ReferenceLattice::mass(uint32_t slot) const {
  if (isGhost(nodes[slot])) return mass(farEnd(slot, springOfGhost(nodes[slot])));
  const uint32_t b = nodes[slot].hi >> layout::kBodyShift;
  if (!strengths_[b].mass_kg.empty()) return strengths_[b].mass_kg[slot - first_[b]];
  return massEighths(nodes[slot]) * static_cast<double>(params_[b].mass_eighth_kg);
}

bool ReferenceLattice::isWhole(uint32_t slot, uint32_t spring) const {
  const int64_t link = neighbor(slot, spring).spring;
  return link < 0 ? springCount(nodes[slot], spring) != 0 : spring_cut[static_cast<size_t>(link)] == 0;
}

double ReferenceLattice::stiffness(uint32_t slot, uint32_t spring) const {
  if (!isWhole(slot, spring)) return 0;
  if (neighbor(slot, spring).spring >= 0) return neighbor(slot, spring).stiffness_n_per_m;
  const uint32_t count = springCount(nodes[slot], spring), b = nodes[slot].hi >> layout::kBodyShift;
  if (!strengths_[b].spring_n_per_m.empty()) {
    const uint32_t near = (spring % 2 ? neighbor(slot, spring).slot : slot) - first_[b];
    return strengths_[b].spring_n_per_m[near * kSpringPairs + spring / 2];
  }
  const double unit = isAxial(spring) ? params_[b].axial_quarter_n_per_m : params_[b].diagonal_half_n_per_m;
  return count * unit;
}

double ReferenceLattice::dashpot(uint32_t slot, uint32_t spring) const {
  const double k = stiffness(slot, spring);
  return k == 0 ? 0 : k * body(slot).dashpot_s;
}

double ReferenceLattice::bulk(uint32_t slot) const {
  if (!(nodes[slot].lo & layout::kCellBit)) return 0;
  const uint32_t b = nodes[slot].hi >> layout::kBodyShift;
  return strengths_[b].bulk_j.empty() ? params_[b].bulk_j : strengths_[b].bulk_j[slot - first_[b]];
}

bool ReferenceLattice::isIsolated(uint32_t slot) const {
  return (nodes[slot].lo & layout::kAxialMask) == 0 && (nodes[slot].hi & layout::kDiagonalMask) == 0;
}

void ReferenceLattice::eraseSpring(uint32_t slot, uint32_t spring, double fraction) {
  if (!isWhole(slot, spring)) return;
  const Neighbor& n = neighbor(slot, spring);
  const bool of_lattice = n.lattice_spring < layout::kSpringsPerNode;
  loseSpring(slot, n.lattice_spring);
  loseSpring(n.slot, of_lattice ? oppositeSpring(n.lattice_spring) : n.lattice_spring);
  // After rounding it must still say that the spring is cut.
  if (n.spring >= 0) spring_cut[static_cast<size_t>(n.spring)] = std::max(static_cast<float>(fraction), kLeastFraction);
  if (of_lattice) killCells(slot, n.slot);
  if (n.lattice_spring >= layout::kAxialSprings) return;
  const bool forward = n.lattice_spring % 2 == 0;
  const double share = std::clamp(forward ? fraction : 1 - fraction, kLeastShare, 1 - kLeastShare);
  const bool erased = fraction == static_cast<double>(layout::kErasedShare);
  axial_cut[3 * (forward ? slot : n.slot) + n.lattice_spring / 2] = erased ? fraction : share;
}

/// Removes one end of a spring from NodeBits.
void ReferenceLattice::loseSpring(uint32_t slot, uint32_t lattice_spring) {
  layout::NodeBits& bits = nodes[slot];
  bits.lo |= layout::kSeveredBit;
  if (lattice_spring < layout::kSpringsPerNode) {
    setSpringCount(bits, lattice_spring, 0);
  } else if (has_valences_[bits.hi >> layout::kBodyShift]) {
    --bits.lo;  // the valence is in the lowest bits
  }
}

/// Removes the volume of the cells with both nodes among their corners.
void ReferenceLattice::killCells(uint32_t slot, uint32_t other) {
  for (int cell : around_[slot]) {
    if (cell < 0) continue;
    const auto& corners = cells_[static_cast<size_t>(cell)].corners;
    if (std::find(corners.begin(), corners.end(), other) == corners.end()) continue;
    nodes[corners[0]].lo &= ~layout::kCellBit;
  }
}

}  // namespace viscera
