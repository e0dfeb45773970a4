// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/solver/reference/reference_lattice.h"

#include <algorithm>

namespace viscera {

namespace {

constexpr std::array<int, 8> kNoCells = {-1, -1, -1, -1, -1, -1, -1, -1};

Vector3i cornerOffset(size_t corner) {
  return {static_cast<int>(corner & 1u), static_cast<int>((corner >> 1) & 1u), static_cast<int>((corner >> 2) & 1u)};
}

}  // namespace

ReferenceLattice::ReferenceLattice(const Model& model)
    : neighbors_(model.slots() * layout::kSpringsPerNode),
      rest_m_(model.slots(), Vector3d::Zero()),
      place_(model.slots(), -1),
      around_(model.slots(), kNoCells) {
  const double dt_safe_s = safeTimeStep(model);
  for (size_t b = 0; b < model.bodies.size(); ++b) addBody(model, b, dt_safe_s);
  for (size_t i = 0; i < active.size(); ++i) place_[active[i]] = static_cast<int>(i);
}

void ReferenceLattice::addBody(const Model& model, size_t b, double dt_safe_s) {
  const Body& body = model.bodies[b];
  const Lattice& lattice = body.lattice;
  const uint32_t first = model.slotOffset(b);
  first_.push_back(first);
  params_.push_back(bodyParams(body, dt_safe_s));
  strengths_.push_back(isHeterogeneous(body) ? strengths(body) : Strengths{});
  for (layout::NodeBits bits : lattice.nodes) {
    bits.hi |= static_cast<uint32_t>(b) << layout::kBodyShift;
    nodes.push_back(bits);
  }
  for (uint32_t slot : lattice.active_slots) {
    active.push_back(first + slot);
    rest_m_[first + slot] = lattice.restPosition(slot);
    for (uint32_t s = 0; s < layout::kSpringsPerNode; ++s) {
      const auto& o = kNeighborOffsets[s];
      const Vector3d offset = lattice.spacing_m * Vector3d(o[0], o[1], o[2]);
      const int64_t other = lattice.neighborSlot(slot, s);
      neighbors_[(first + slot) * layout::kSpringsPerNode + s] = {other < 0 ? 0u : first + static_cast<uint32_t>(other),
                                                                  offset, offset.norm()};
    }
    if (lattice.nodes[slot].lo & layout::kCellBit) addCell(lattice, first, slot);
  }
}

void ReferenceLattice::addCell(const Lattice& lattice, uint32_t first, uint32_t local) {
  Cell cell{{}, lattice.spacing_m};
  const Vector3i lowest = lattice.nodeAt(local);
  for (size_t c = 0; c < 8; ++c) {
    cell.corners[c] = first + static_cast<uint32_t>(lattice.slotAt(lowest + cornerOffset(c)));
    around_[cell.corners[c]][c] = static_cast<int>(cells_.size());
  }
  cells_.push_back(cell);
}

double ReferenceLattice::mass(uint32_t slot) const {
  const uint32_t b = nodes[slot].hi >> layout::kBodyShift;
  if (!strengths_[b].mass_kg.empty()) return strengths_[b].mass_kg[slot - first_[b]];
  return massEighths(nodes[slot]) * static_cast<double>(params_[b].mass_eighth_kg);
}

double ReferenceLattice::stiffness(uint32_t slot, uint32_t spring) const {
  const uint32_t count = springCount(nodes[slot], spring), b = nodes[slot].hi >> layout::kBodyShift;
  if (count == 0) return 0;
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

void ReferenceLattice::eraseSpring(uint32_t slot, uint32_t spring) {
  const uint32_t other = neighbor(slot, spring).slot;
  setSpringCount(nodes[slot], spring, 0);
  setSpringCount(nodes[other], oppositeSpring(spring), 0);
  nodes[slot].lo |= layout::kSeveredBit;
  nodes[other].lo |= layout::kSeveredBit;
  for (int cell : around_[slot]) {  // the cells that have both ends among their corners
    if (cell < 0) continue;
    const auto& corners = cells_[static_cast<size_t>(cell)].corners;
    if (std::find(corners.begin(), corners.end(), other) == corners.end()) continue;
    nodes[corners[0]].lo &= ~layout::kCellBit;
  }
}

}  // namespace viscera
