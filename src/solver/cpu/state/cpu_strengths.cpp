// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/state/cpu_strengths.h"

#include <algorithm>
#include <array>

#include "solver/cpu/simd/kernels.h"
#include "solver/cpu/state/cell_numbers.h"
#include "solver/cpu/state/slot_beside.h"
#include "solver/tissue/joined_lattice.h"
#include "viscera/solver/material.h"

namespace viscera {

namespace {

/// A spring within a cell: the corner where it begins (bit per axis, x lowest) and its pair. The order is that of
/// kBrokenSprings (VISCERA_SPRINGS_WITHIN in law_bricks-inl.h).
struct SpringWithin {
  int corner;
  uint32_t pair;
};
constexpr SpringWithin kSpringsWithin[simd::kBrokenSprings] = {
    {0, 0}, {2, 0}, {4, 0}, {6, 0}, {0, 1}, {1, 1}, {4, 1}, {5, 1}, {0, 2}, {1, 2}, {2, 2}, {3, 2},
    {0, 3}, {4, 3}, {2, 4}, {6, 4}, {0, 5}, {2, 5}, {4, 6}, {6, 6}, {0, 7}, {1, 7}, {4, 8}, {5, 8}};

constexpr size_t kBrokenPlanes = simd::kBrokenNumbers * layout::kBrickSlots;
/// Bricks with broken cells per allocation, 2 MB, so that a tick in which a blade cuts allocates nothing.
constexpr size_t kSlabBricks = 256;

void addSlab(std::vector<AlignedVector<float>>& slabs) {
  slabs.emplace_back(kSlabBricks * kBrokenPlanes);
}

bool isAlone(const layout::NodeBits& bits) {
  return (bits.lo & layout::kAxialMask) == 0 && (bits.hi & layout::kDiagonalMask) == 0;
}

/// Returns the strain of springs that carry a cell's prestress, along a direction: n.E.n with E = (S - tr S / 5) / 2
/// over mu.
/// @param s  xx, yy, zz; yz, zx, xy
float strainOfStress(const layout::vec4* s, const std::array<int, 3>& offset) {
  const auto x = static_cast<float>(offset[0]), y = static_cast<float>(offset[1]), z = static_cast<float>(offset[2]);
  const float along =
      s[0].x * x * x + s[0].y * y * y + s[0].z * z * z + 2 * (s[1].x * y * z + s[1].y * z * x + s[1].z * x * y);
  return 0.5f * (along / (x * x + y * y + z * z) - (s[0].x + s[0].y + s[0].z) / 5);
}

}  // namespace

CpuStrengths::CpuStrengths(const Model& model, const CpuStore& store, const FeatureSet& features,
                           const std::vector<float>& masses_kg)
    : stiffness(store.slotCount() * kSpringPairs),
      mass(store.slotCount(), 1),
      surface_depth(surfaceDepths(model)),
      surface_offsets(surfaceOffsets(model)),
      mobility(store.slotCount()),
      both_ends(store.slotCount() * layout::kSpringsPerNode),
      uniform(store.brickCount()),
      idle_rows(store.brickCount()) {
  if (features.parts) table_ = allStrengths(model);
  if (features.tears) left.assign(store.slotCount() * kSpringPairs, 1);
  for (uint32_t slot : store.active) {
    const layout::BodyParams& body = store.bodyOf(slot);
    mass[slot] = table_.mass_kg.empty() ? static_cast<float>(massEighths(store.nodes[slot])) * body.mass_eighth_kg
                                        : table_.mass_kg[slot];
    if (!masses_kg.empty()) mass[slot] = masses_kg[slot];
  }
  if (features.law) {
    bulk.resize(store.slotCount());
    rigidity.resize(store.slotCount());
    broken.resize(store.brickCount());
    if (features.cuts) addSlab(broken_slabs_);
    moments = allMoments(model);
    idle_cells.resize(store.brickCount());
    for (const Body& body : model.bodies) has_parts |= !body.parts.empty();
    spreadMoments(store);
    spreadTensions(store);
    spreadLaminates(store);
    if (features.walls) walls = CpuWalls(store, moments, table_, mass);
  }
  refreshAll(store);
}

float CpuStrengths::springStiffness(const CpuStore& store, uint32_t slot, uint32_t pair) const {
  const uint32_t count = springCount(store.nodes[slot], 2 * pair);
  if (count == 0) return 0;
  const float left_of_it = left.empty() ? 1 : left[stiffnessAt(slot, pair)];
  if (!table_.spring_n_per_m.empty()) return left_of_it * table_.spring_n_per_m[slot * kSpringPairs + pair];
  const layout::BodyParams& body = store.bodyOf(slot);
  return left_of_it * static_cast<float>(count) *
         (isAxial(2 * pair) ? body.axial_quarter_n_per_m : body.diagonal_half_n_per_m);
}

float CpuStrengths::cellBulk(const CpuStore& store, uint32_t slot) const {
  if (!(store.nodes[slot].lo & layout::kCellBit) || hasSoftened(store, slot)) return 0;
  return table_.bulk_j.empty() ? store.bodyOf(slot).bulk_j : table_.bulk_j[slot];
}

float CpuStrengths::cellRigidity(const CpuStore& store, uint32_t slot) const {
  if (!(store.nodes[slot].lo & layout::kCellBit) || hasSoftened(store, slot)) return 0;
  return wholeRigidity(store, slot);
}

/// Returns the rigidity of the cell above a slot before any cut [J]. The cell must exist.
float CpuStrengths::wholeRigidity(const CpuStore& store, uint32_t slot) const {
  return table_.rigidity_j.empty() ? store.bodyOf(slot).rigidity_j : table_.rigidity_j[slot];
}

/// Updates the remaining springs of the cells around a node, which may have lost some.
void CpuStrengths::breakCells(const CpuStore& store, uint32_t slot) {
  for (int c = 0; c < 8; ++c) {
    const uint32_t cell = slotBeside(store.bricks, slot, {-(c & 1), -(c >> 1 & 1), -(c >> 2 & 1)});
    if (cell == kNoSlot || !(store.nodes[cell].lo & layout::kLawCellBit)) continue;
    if (cellRigidity(store, cell) == 0) setBroken(store, cell);
  }
}

void CpuStrengths::setBroken(const CpuStore& store, uint32_t cell) {
  const uint32_t brick = cell / layout::kBrickSlots, local = cell % layout::kBrickSlots;
  if (broken[brick] == nullptr) broken[brick] = newBrokenPlanes();
  float* planes = broken[brick];
  // Times 4 h: a quarter of k along an edge, a half along a diagonal, k = rigidity / h^2.
  const float of_edge = wholeRigidity(store, cell) / store.bodyOf(cell).origin_spacing.w;
  for (uint32_t s = 0; s < simd::kBrokenSprings; ++s) {
    const auto& [corner, pair] = kSpringsWithin[s];
    const uint32_t near = neighborSlot(store.bricks, cell, {corner & 1, corner >> 1 & 1, corner >> 2 & 1});
    const float left_of_it = left.empty() ? 1 : left[stiffnessAt(near, pair)];
    const bool alive = springCount(store.nodes[near], 2 * pair) != 0;
    planes[simd::cellNumberAt(local, s, simd::kBrokenNumbers)] =
        alive ? left_of_it * (isAxial(2 * pair) ? of_edge : 2 * of_edge) : 0;
  }
  const layout::vec4* stress = moments.stressOf(cell);
  for (uint32_t pair = 0; pair < kSpringPairs && stress != nullptr; ++pair) {
    const float length = 1 - strainOfStress(stress, kNeighborOffsets[2 * pair]);
    planes[simd::cellNumberAt(local, simd::kBrokenSprings + pair, simd::kBrokenNumbers)] = 1 / (length * length) - 1;
  }
}

/// Returns the planes of one more brick, all 0.
float* CpuStrengths::newBrokenPlanes() {
  if (broken_bricks_ == broken_slabs_.size() * kSlabBricks) addSlab(broken_slabs_);
  float* planes = &broken_slabs_[broken_bricks_ / kSlabBricks][broken_bricks_ % kSlabBricks * kBrokenPlanes];
  ++broken_bricks_;
  std::fill(planes, planes + kBrokenPlanes, 0.0f);
  return planes;
}

/// Updates the cells in thin walls around a node for the springs that it has.
void CpuStrengths::refreshWalls(const CpuStore& store, uint32_t slot) {
  for (int c = 0; c < 8; ++c) {
    const uint32_t cell = slotBeside(store.bricks, slot, {-(c & 1), -(c >> 1 & 1), -(c >> 2 & 1)});
    if (cell != kNoSlot && walls.has(cell))
      walls.refresh(store, cell, cellRigidity(store, cell), cellBulk(store, cell));
  }
}

/// Returns whether one of a cell's 24 springs has softened. Such a cell resists with its springs only; otherwise it
/// would hold a tear together.
bool CpuStrengths::hasSoftened(const CpuStore& store, uint32_t slot) const {
  for (int c = 0; c < 8 && !left.empty(); ++c) {
    const std::array<int, 3> corner = {c & 1, c >> 1 & 1, c >> 2 & 1};
    const uint32_t at = neighborSlot(store.bricks, slot, corner);
    for (uint32_t pair = 0; pair < kSpringPairs; ++pair) {
      bool inside = true;
      for (size_t axis = 0; axis < 3; ++axis) {
        const int to = corner[axis] + kNeighborOffsets[2 * pair][axis];
        inside = inside && (to == 0 || to == 1);
      }
      if (inside && left[stiffnessAt(at, pair)] < 1) return true;
    }
  }
  return false;
}

void CpuStrengths::refresh(const CpuStore& store, uint32_t slot) {
  const layout::NodeBits& bits = store.nodes[slot];
  const bool stays = (bits.lo & layout::kFixedBit) != 0 || (isAlone(bits) && (bits.lo & layout::kGrabMask) == 0);
  mobility[slot] = stays ? 0 : 1 / mass[slot];
  if (store.connections(slot) == layout::kNetwork) return;
  for (uint32_t pair = 0; pair < kSpringPairs; ++pair)
    stiffness[stiffnessAt(slot, pair)] = springStiffness(store, slot, pair);
  const uint32_t brick = slot / layout::kBrickSlots;
  for (uint32_t spring = 0; spring < layout::kSpringsPerNode; ++spring) {
    const bool alive = springCount(bits, spring) != 0;
    const uint32_t owner =
        spring % 2 == 0 || !alive ? slot : neighborSlot(store.bricks, slot, kNeighborOffsets[spring]);
    both_ends[simd::springAt(slot, spring)] = alive ? springStiffness(store, owner, spring / 2) : 0;
  }
  uniform[brick] = uniform[brick] && isFull(store, slot);
  if (bulk.empty()) return;
  bulk[slot] = cellBulk(store, slot);
  rigidity[slot] = walls.has(slot) ? 0 : cellRigidity(store, slot);
  breakCells(store, slot);
  if (walls.empty()) return;
  refreshWalls(store, slot);
  refreshGhosts(store, slot);
}

/// Updates the ghosts of a fixed node: a ghost moves while its row is whole.
void CpuStrengths::refreshGhosts(const CpuStore& store, uint32_t slot) {
  const layout::NodeBits& bits = store.nodes[slot];
  for (int axis = 0; axis < 3; ++axis) {
    if (!hasGhost(bits, axis)) continue;
    const uint32_t spring = springToGhost(store.whole_nodes[slot], axis);
    const uint32_t ghost = neighborSlot(store.bricks, slot, kNeighborOffsets[spring]);
    mass[ghost] = mass[slot];
    mobility[ghost] = isWithinRow(bits, axis) ? 1 / mass[slot] : 0;
  }
}

/// Fills brick_moments and partial_rows.
void CpuStrengths::spreadMoments(const CpuStore& store) {
  constexpr size_t kBrick = simd::kMomentNumbers * layout::kBrickSlots;
  std::vector<uint32_t> partial;
  for (uint32_t b = 0; b < store.brickCount(); ++b) {
    const uint32_t* first = &moments.of_cell[size_t{b} * layout::kBrickSlots];
    if (std::any_of(first, first + layout::kBrickSlots, [](uint32_t which) { return which != 0; }))
      partial.push_back(b);
  }
  moment_planes_.resize(partial.size() * kBrick);
  brick_moments.assign(store.brickCount(), nullptr);
  partial_rows.assign(store.brickCount(), 0);
  for (size_t i = 0; i < partial.size(); ++i) {
    float* planes = &moment_planes_[i * kBrick];
    brick_moments[partial[i]] = planes;
    for (size_t local = 0; local < layout::kBrickSlots; ++local) {
      const uint32_t which = moments.of_cell[partial[i] * layout::kBrickSlots + local];
      if (which != 0) partial_rows[partial[i]] = static_cast<uint16_t>(partial_rows[partial[i]] | 1u << (local / 4));
      const layout::vec4* m = &moments.vectors[kVectorsPerFill * which];
      for (size_t v = 0; v < kVectorsPerFill; ++v) {
        for (size_t c = 0; c < 3; ++c)
          planes[simd::cellNumberAt(static_cast<uint32_t>(local), static_cast<uint32_t>(3 * v + c),
                                    simd::kMomentNumbers)] = lawMoment(m, v, c);
      }
    }
  }
}

/// Fills brick_tensions.
void CpuStrengths::spreadTensions(const CpuStore& store) {
  constexpr size_t kBrick = simd::kTensionNumbers * layout::kBrickSlots;
  brick_tensions.assign(store.brickCount(), nullptr);
  if (moments.stress_of_cell.empty()) return;
  tension_planes_.resize(store.brickCount() * kBrick);
  for (uint32_t slot = 0; slot < store.slotCount(); ++slot) {
    const layout::vec4* s = moments.stressOf(slot);
    if (s == nullptr) continue;
    const uint32_t brick = slot / layout::kBrickSlots, local = slot % layout::kBrickSlots;
    float* planes = &tension_planes_[brick * kBrick];
    brick_tensions[brick] = planes;
    const float six[] = {s[0].x, s[0].y, s[0].z, s[1].x, s[1].y, s[1].z};
    for (uint32_t n = 0; n < simd::kTensionNumbers; ++n)
      planes[simd::cellNumberAt(local, n, simd::kTensionNumbers)] = six[n];
  }
}

/// Fills brick_laminates. Cells with one material get two equal layers with equal gradients.
void CpuStrengths::spreadLaminates(const CpuStore& store) {
  constexpr size_t kBrick = simd::kLaminateNumbers * layout::kBrickSlots;
  std::vector<uint32_t> bricks;
  brick_laminates.assign(store.brickCount(), nullptr);
  for (uint32_t slot = 0; slot < store.slotCount(); ++slot) {
    const uint32_t brick = slot / layout::kBrickSlots;
    if (moments.laminateOf(slot) != nullptr && (bricks.empty() || bricks.back() != brick)) bricks.push_back(brick);
  }
  laminate_planes_.resize(bricks.size() * kBrick);
  for (size_t i = 0; i < bricks.size(); ++i) {
    float* planes = &laminate_planes_[i * kBrick];
    brick_laminates[bricks[i]] = planes;
    for (uint32_t local = 0; local < layout::kBrickSlots; ++local) {
      const LaminateNumbers numbers = laminateNumbers(moments, table_, bricks[i] * layout::kBrickSlots + local);
      for (uint32_t n = 0; n < simd::kLaminateNumbers; ++n)
        planes[simd::cellNumberAt(local, n, simd::kLaminateNumbers)] = numbers[n];
    }
  }
}

float CpuStrengths::bulkAround(const CpuStore& store, uint32_t slot) const {
  float sum = 0;
  for (int c = 0; c < 8 && !bulk.empty(); ++c) {
    const uint32_t cell = slotBeside(store.bricks, slot, {-(c & 1), -(c >> 1 & 1), -(c >> 2 & 1)});
    if (cell != kNoSlot) sum += std::max(0.0f, bulk[cell]);
  }
  return sum;
}

bool CpuStrengths::isFull(const CpuStore& store, uint32_t slot) const {
  const layout::BodyParams& body = store.bodyOf(slot);
  for (uint32_t spring = 0; spring < layout::kSpringsPerNode; ++spring) {
    const float full = isAxial(spring) ? 4 * body.axial_quarter_n_per_m : 2 * body.diagonal_half_n_per_m;
    if (both_ends[simd::springAt(slot, spring)] != full) return false;
  }
  return true;
}

void CpuStrengths::refreshAll(const CpuStore& store) {
  for (size_t b = 0; b < store.bricks.size(); ++b)
    uniform[b] = store.first_active[b + 1] - store.first_active[b] == layout::kBrickSlots;
  std::fill(broken.begin(), broken.end(), nullptr);
  broken_bricks_ = 0;
  for (uint32_t slot : store.active) refresh(store, slot);
  recordIdleRows();
  if (!rigidity.empty()) recordCells(store);
}

void CpuStrengths::recordIdleRows() {
  for (size_t b = 0; b < idle_rows.size(); ++b) {
    idle_rows[b] = 0;
    for (size_t row = 0; row < 16; ++row) {
      const float* of_row = &mobility[b * layout::kBrickSlots + 4 * row];
      if (std::all_of(of_row, of_row + 4, [](float value) { return value == 0; })) {
        idle_rows[b] = static_cast<uint16_t>(idle_rows[b] | 1u << row);
      }
    }
  }
}

/// Fills idle_cells.
void CpuStrengths::recordCells(const CpuStore& store) {
  for (uint32_t b = 0; b < store.brickCount(); ++b) {
    idle_cells[b] = 0;
    for (uint32_t row = 0; row < 16; ++row) {
      if (isIdleRow(store, b * layout::kBrickSlots + 4 * row))
        idle_cells[b] = static_cast<uint16_t>(idle_cells[b] | 1u << row);
    }
  }
}

/// Returns whether four cells have no law, or only nodes that never move.
/// @param first  slot of the first cell
bool CpuStrengths::isIdleRow(const CpuStore& store, uint32_t first) const {
  bool nothing = true, still = true;
  for (uint32_t slot = first; slot < first + 4; ++slot) {
    nothing = nothing && !(store.nodes[slot].lo & layout::kLawCellBit);
    for (int c = 0; c < 8; ++c) {
      still = still && mobility[neighborSlot(store.bricks, slot, {c & 1, c >> 1 & 1, c >> 2 & 1})] == 0;
    }
  }
  return nothing || still;
}

}  // namespace viscera
