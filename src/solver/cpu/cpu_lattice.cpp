// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/cpu_lattice.h"

#include <algorithm>
#include <array>

#include "solver/joined_lattice.h"

namespace viscera {

namespace {

bool isAlone(const layout::NodeBits& bits) {
  return (bits.lo & layout::kAxialMask) == 0 && (bits.hi & layout::kDiagonalMask) == 0;
}

std::vector<uint32_t> firstOfBricks(const std::vector<uint32_t>& active, size_t bricks) {
  std::vector<uint32_t> out(bricks + 1);
  for (uint32_t slot : active) ++out[slot / layout::kBrickSlots + 1];
  for (size_t b = 0; b < bricks; ++b) out[b + 1] += out[b];
  return out;
}

/// Slot of the neighbour at an offset, whose brick must be there (shaders/solver/lattice.glsl).
uint32_t neighborSlot(const std::vector<layout::Brick>& bricks, uint32_t slot, const std::array<int, 3>& offset) {
  int direction = 0, inside = 0;
  constexpr int kDirection[3] = {1, 3, 9}, kShift[3] = {0, 2, 4};
  for (int axis = 0; axis < 3; ++axis) {
    const int at = static_cast<int>(slot >> kShift[axis] & 3) + offset[static_cast<size_t>(axis)];  // -1 .. 4
    direction += kDirection[axis] * ((at + 4) >> 2);
    inside |= (at & 3) << kShift[axis];
  }
  const layout::Brick& brick = bricks[slot / layout::kBrickSlots];
  return brick.neighbors[direction] * layout::kBrickSlots + static_cast<uint32_t>(inside);
}

std::vector<layout::vec4> gathered(const AlignedVector<float>& planes, size_t slots) {
  std::vector<layout::vec4> out(slots);
  for (uint32_t slot = 0; slot < slots; ++slot) {
    const float* at = &planes[vectorAt(slot)];
    out[slot] = {at[0], at[64], at[128], 0};
  }
  return out;
}

void scatter(const std::vector<layout::vec4>& values, AlignedVector<float>& planes) {
  for (uint32_t slot = 0; slot < values.size(); ++slot) {
    float* at = &planes[vectorAt(slot)];
    at[0] = values[slot].x;
    at[64] = values[slot].y;
    at[128] = values[slot].z;
  }
}

template <class Values>
void clear(Values& values) {
  std::fill(values.begin(), values.end(), typename Values::value_type{});
}

}  // namespace

CpuLattice::CpuLattice(const Model& model, const std::vector<layout::BodyParams>& params, const FeatureSet& features)
    : bricks(allBricks(model)),
      bodies(params),
      nodes(allNodes(model)),
      active(activeSlots(model)),
      first_active(firstOfBricks(active, bricks.size())),
      cells(cellSlots(model)),
      stiffness(nodes.size() * kSpringPairs),
      mass(nodes.size(), 1),
      mobility(nodes.size()),
      both_ends(nodes.size() * layout::kSpringsPerNode),
      uniform(bricks.size()),
      idle_rows(bricks.size()),
      network(joinNetworks(model)),
      edge_forces(features.edge_forces ? orderByOwner(network) : EdgeForces{}),
      spring_cut(network.springs.size()),
      whole_nodes_(nodes),
      whole_links_(network.links) {
  for (int i = 0; i < 2; ++i) {
    displacement[i].resize(3 * nodes.size());
    velocity[i].resize(3 * nodes.size());
  }
  if (features.parts) strengths_ = allStrengths(model);
  for (uint32_t slot : active) {
    const layout::BodyParams& body = bodies[nodes[slot].hi >> layout::kBodyShift];
    mass[slot] = strengths_.mass_kg.empty() ? static_cast<float>(massEighths(nodes[slot])) * body.mass_eighth_kg
                                            : strengths_.mass_kg[slot];
    if (!network.masses_kg.empty()) mass[slot] = network.masses_kg[slot];
  }
  if (features.volume) {
    bulk.resize(nodes.size());
    bulk_around.resize(nodes.size() * 8);
  }
  if (features.tools) {
    grab_offsets.resize(nodes.size());
    impulses.resize(nodes.size() * layout::kMaxStyluses);
    touched.resize(bricks.size());
    held.resize(bricks.size());
  }
  refreshAll();
}

float CpuLattice::springStiffness(uint32_t slot, uint32_t pair) const {
  const uint32_t count = springCount(nodes[slot], 2 * pair);
  if (count == 0) return 0;
  if (!strengths_.spring_n_per_m.empty()) return strengths_.spring_n_per_m[slot * kSpringPairs + pair];
  const layout::BodyParams& body = bodies[nodes[slot].hi >> layout::kBodyShift];
  return static_cast<float>(count) * (isAxial(2 * pair) ? body.axial_quarter_n_per_m : body.diagonal_half_n_per_m);
}

float CpuLattice::cellBulk(uint32_t slot) const {
  if (!(nodes[slot].lo & layout::kCellBit)) return 0;
  return strengths_.bulk_j.empty() ? bodies[nodes[slot].hi >> layout::kBodyShift].bulk_j : strengths_.bulk_j[slot];
}

void CpuLattice::refresh(uint32_t slot) {
  const layout::NodeBits& bits = nodes[slot];
  const bool stays = (bits.lo & layout::kFixedBit) != 0 || (isAlone(bits) && (bits.lo & layout::kGrabMask) == 0);
  mobility[slot] = stays ? 0 : 1 / mass[slot];
  if (connections(slot) == layout::kNetwork) return;
  for (uint32_t pair = 0; pair < kSpringPairs; ++pair) stiffness[stiffnessAt(slot, pair)] = springStiffness(slot, pair);
  const uint32_t brick = slot / layout::kBrickSlots, local = slot % layout::kBrickSlots;
  for (uint32_t spring = 0; spring < layout::kSpringsPerNode; ++spring) {
    const bool alive = springCount(bits, spring) != 0;
    const uint32_t owner = spring % 2 == 0 || !alive ? slot : neighborSlot(bricks, slot, kNeighborOffsets[spring]);
    both_ends[size_t{brick} * 1152 + spring * 64 + local] = alive ? springStiffness(owner, spring / 2) : 0;
  }
  uniform[brick] = uniform[brick] && isFull(slot);
  if (bulk.empty()) return;
  bulk[slot] = cellBulk(slot);
  shareBulk(slot);
}

/// Tells the corners of the cell above a slot of its bulk.
void CpuLattice::shareBulk(uint32_t slot) {
  if (!(whole_nodes_[slot].lo & layout::kCellBit)) return;
  for (int c = 0; c < 8; ++c) {
    const uint32_t corner = neighborSlot(bricks, slot, {c & 1, c >> 1 & 1, c >> 2 & 1});
    bulk_around[size_t{corner / layout::kBrickSlots} * 512 + static_cast<size_t>(c) * 64 +
                corner % layout::kBrickSlots] = bulk[slot];
  }
}

bool CpuLattice::isFull(uint32_t slot) const {
  const layout::BodyParams& body = bodies[nodes[slot].hi >> layout::kBodyShift];
  const float* k = &both_ends[size_t{slot / layout::kBrickSlots} * 1152 + slot % layout::kBrickSlots];
  for (uint32_t spring = 0; spring < layout::kSpringsPerNode; ++spring) {
    const float full = isAxial(spring) ? 4 * body.axial_quarter_n_per_m : 2 * body.diagonal_half_n_per_m;
    if (k[spring * 64] != full) return false;
  }
  return true;
}

void CpuLattice::refreshAll() {
  for (size_t b = 0; b < bricks.size(); ++b) uniform[b] = first_active[b + 1] - first_active[b] == layout::kBrickSlots;
  for (uint32_t slot : active) refresh(slot);
  noteIdleRows();
}

void CpuLattice::noteIdleRows() {
  for (size_t b = 0; b < bricks.size(); ++b) {
    idle_rows[b] = 0;
    for (size_t row = 0; row < 16; ++row) {
      const float* of_row = &mobility[b * layout::kBrickSlots + 4 * row];
      if (std::all_of(of_row, of_row + 4, [](float value) { return value == 0; })) {
        idle_rows[b] = static_cast<uint16_t>(idle_rows[b] | 1u << row);
      }
    }
  }
}

void CpuLattice::reset() {
  nodes = whole_nodes_;
  for (int i = 0; i < 2; ++i) {
    clear(displacement[i]);
    clear(velocity[i]);
  }
  clear(grab_offsets);
  clear(impulses);
  clear(touched);
  current = 0;
  writeSpringCut({});
  refreshAll();
}

HostState CpuLattice::read() const {
  return {gathered(displacement[current], slotCount()), gathered(velocity[current], slotCount()), nodes, spring_cut};
}

void CpuLattice::write(const HostState& state) {
  scatter(state.displacement_m, displacement[current]);
  scatter(state.velocity_m_per_s, velocity[current]);
  nodes = state.nodes;
  writeSpringCut(state.spring_cut);
  refreshAll();
}

void CpuLattice::writeSpringCut(const std::vector<float>& cut) {
  if (network.springs.empty()) return;
  network.links = whole_links_;
  clear(spring_cut);
  std::copy(cut.begin(), cut.end(), spring_cut.begin());
  eraseSprings(cut, network.springs, network.links);
}

}  // namespace viscera
