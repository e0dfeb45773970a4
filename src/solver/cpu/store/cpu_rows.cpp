// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// What strengths know of cells in thin walls.
#include <algorithm>

#include "solver/cpu/store/cpu_rows.h"
#include "solver/cpu/store/cpu_strengths.h"
#include "solver/cpu/store/slot_beside.h"
#include "viscera/model/body/neighbors.h"

namespace viscera {

namespace {

/// Place of the rows along an axis among a cell's numbers.
constexpr uint32_t rowsAt(uint32_t axis) {
  return 3 + axis;
}

bool isWithinRow(const layout::NodeBits& bits, uint32_t axis) {
  return springCount(bits, 2 * axis) != 0 && springCount(bits, 2 * axis + 1) != 0;
}

}  // namespace

/// Makes brick_walls and wall_rows; rows are refreshWalls()'s.
void CpuStrengths::spreadWalls(const CpuStore& store) {
  constexpr size_t kBrick = simd::kWallNumbers * layout::kBrickSlots;
  brick_walls.assign(store.brickCount(), nullptr);
  wall_rows.assign(store.brickCount(), 0);
  std::vector<uint32_t> cells;
  size_t bricks = 0;
  for (uint32_t slot = 0; slot < store.slotCount(); ++slot) {
    if (moments.wallOf(slot) == nullptr) continue;
    const bool first = cells.empty() || cells.back() / layout::kBrickSlots != slot / layout::kBrickSlots;
    bricks += first ? 1 : 0;
    cells.push_back(slot);
  }
  wall_planes_.resize(bricks * kBrick);
  bricks = 0;
  for (const uint32_t slot : cells) {
    const uint32_t brick = slot / layout::kBrickSlots, local = slot % layout::kBrickSlots;
    if (brick_walls[brick] == nullptr) brick_walls[brick] = &wall_planes_[kBrick * bricks++];
    wall_rows[brick] = static_cast<uint16_t>(wall_rows[brick] | 1u << (local / 4));
    const layout::vec4* wall = moments.wallOf(slot);
    const float numbers[simd::kWallNumbers] = {wall[0].x, wall[0].y, wall[0].z, 0, 0, 0, wall[0].w, wall[1].x};
    for (uint32_t n = 0; n < simd::kWallNumbers; ++n)
      brick_walls[brick][simd::cellNumberAt(local, n, simd::kWallNumbers)] = numbers[n];
  }
}

/// Fits the rows of the cells around a node to the springs that it has: along an axis without any rows a cell has its
/// own second derivative.
void CpuStrengths::refreshWalls(const CpuStore& store, uint32_t slot) {
  for (int c = 0; c < 8; ++c) {
    const uint32_t cell = slotBeside(store.bricks, slot, {-(c & 1), -(c >> 1 & 1), -(c >> 2 & 1)});
    const layout::vec4* wall = cell == kNoSlot ? nullptr : moments.wallOf(cell);
    if (wall == nullptr) continue;
    const uint32_t brick = cell / layout::kBrickSlots, local = cell % layout::kBrickSlots;
    for (uint32_t axis = 0; axis < 3; ++axis) {
      bool any = false;
      for (int corner = 0; corner < 8 && !any; ++corner) {
        const uint32_t at = neighborSlot(store.bricks, cell, {corner & 1, corner >> 1 & 1, corner >> 2 & 1});
        any = isWithinRow(store.nodes[at], axis);
      }
      brick_walls[brick][simd::cellNumberAt(local, rowsAt(axis), simd::kWallNumbers)] = any ? wall[0].w : 0;
    }
  }
}

CpuRows::CpuRows(const CpuStore& store, const CpuStrengths& strengths) {
  if (strengths.brick_walls.empty()) return;
  place_.assign(store.brickCount(), 0);
  brick_of_ = {0};
  std::vector<uint8_t> wanted(store.brickCount(), 0);
  for (uint32_t b = 0; b < store.brickCount(); ++b) {
    if (strengths.brick_walls[b] == nullptr) continue;
    for (const uint32_t beside : store.bricks[b].neighbors) wanted[beside] = 1;
  }
  for (uint32_t b = 0; b < store.brickCount(); ++b) {
    if (!wanted[b]) continue;
    place_[b] = static_cast<uint32_t>(brick_of_.size());
    brick_of_.push_back(b);
  }
  bricks_.resize(brick_of_.size());
  std::fill(std::begin(bricks_[0].neighbors), std::end(bricks_[0].neighbors), 0u);
  for (uint32_t place = 1; place < brick_of_.size(); ++place) {
    const uint32_t b = brick_of_[place];
    bricks_[place] = store.bricks[b];
    for (size_t n = 0; n < 27; ++n) {
      const uint32_t beside = store.bricks[b].neighbors[n];
      bricks_[place].neighbors[n] = beside == b && n != 13 ? 0 : place_[beside];
    }
  }
  for (size_t axis = 0; axis < 3; ++axis) {
    values_[axis].resize(192 * brick_of_.size());
    ends_[axis].resize(192 * brick_of_.size());
    sums_[axis].resize(simd::kCellSums * brick_of_.size());
  }
  for (uint32_t place = 1; place < brick_of_.size(); ++place) all_.push_back(place);
  walls_ = strengths.brick_walls.data();
  wall_rows_ = strengths.wall_rows.data();
}

simd::RowArrays CpuRows::arrays() {
  simd::RowArrays out{};
  if (place_.empty()) return out;
  out.place = place_.data();
  out.brick_of = brick_of_.data();
  out.bricks = bricks_.data();
  for (size_t axis = 0; axis < 3; ++axis) {
    out.values[axis] = values_[axis].data();
    out.ends[axis] = ends_[axis].data();
    out.sums[axis] = sums_[axis].data();
  }
  out.walls = walls_;
  out.wall_rows = wall_rows_;
  return out;
}

std::vector<uint32_t> CpuRows::around(const CpuStore& store, const std::vector<uint32_t>& bricks) const {
  std::vector<uint8_t> wanted(brick_of_.size(), 0);
  for (const uint32_t b : bricks) {
    if (place_[b] == 0) continue;
    for (const uint32_t beside : store.bricks[b].neighbors) wanted[place_[beside]] = 1;
  }
  std::vector<uint32_t> out;
  for (uint32_t place = 1; place < wanted.size(); ++place) {
    if (wanted[place]) out.push_back(place);
  }
  return out;
}

}  // namespace viscera
