// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/state/cpu_walls.h"

#include <algorithm>

#include "solver/cpu/simd/wall_nodes.h"
#include "solver/cpu/state/cell_numbers.h"
#include "solver/cpu/state/slot_beside.h"
#include "viscera/model/body/neighbors.h"

namespace viscera {

namespace {

using simd::kWallLanes;

std::array<int, 3> cornerOffset(uint32_t corner) {
  return {static_cast<int>(corner & 1), static_cast<int>(corner >> 1 & 1), static_cast<int>(corner >> 2 & 1)};
}

/// Returns the index of the spring from a corner of a cell outwards along an axis.
uint32_t outward(uint32_t corner, int axis) {
  return static_cast<uint32_t>(2 * axis) + (corner >> axis & 1 ? 0 : 1);
}

/// Returns whether there is a node or a ghost beyond a node in the direction of an axial spring.
bool isBeyond(const layout::NodeBits& whole, uint32_t spring) {
  return springCount(whole, spring) != 0 || hasGhost(whole, static_cast<int>(spring / 2));
}

/// Returns the index of a number of a cell in arrays with `numbers` of them per group.
size_t numberAt(size_t position, uint32_t number, uint32_t numbers) {
  return (position / kWallLanes * numbers + number) * kWallLanes + position % kWallLanes;
}

void sortAndUnite(std::vector<uint32_t>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

}  // namespace

CpuWalls::CpuWalls(const CpuStore& store, const JoinedMoments& moments, const Strengths& table,
                   const AlignedVector<float>& masses_kg) {
  uint32_t body = 0;
  for (uint32_t slot = 0; slot < store.slotCount(); ++slot) {
    if (moments.wallOf(slot) == nullptr) continue;
    const uint32_t here = store.nodes[slot].hi >> layout::kBodyShift;
    if (here != body) cells_.resize((cells_.size() + kWallLanes - 1) / kWallLanes * kWallLanes, kNone);
    body = here;
    if (cells_.size() % kWallLanes == 0) bodies_.push_back(body);
    cells_.push_back(slot);
  }
  if (cells_.empty()) return;
  cells_.resize(bodies_.size() * kWallLanes, kNone);
  position_.assign(store.slotCount(), kNone);
  cells_of_.resize(store.brickCount());
  for (uint32_t i = 0; i < cells_.size(); ++i) {
    if (cells_[i] == kNone) continue;
    position_[cells_[i]] = i;
    cells_of_[cells_[i] / layout::kBrickSlots].push_back(i);
  }
  listGroups(listNodes(store));
  addNumbers(moments, table);
  addForces();
  ghosts_kg_.resize(slots_.size());
  for (size_t n = 0; n < slots_.size(); ++n) {
    const layout::NodeBits& bits = store.nodes[slots_[n]];
    if (!isGhost(bits)) continue;
    ghosts_kg_[n] = masses_kg[neighborSlot(store.bricks, slots_[n], kNeighborOffsets[springOfGhost(bits)])];
  }
}

/// Fills slots_ and bricks_of_. Where there is no node beyond a corner, the corner takes its place with weight 0.
/// @return [groups][kWallNodes][kWallLanes] index in slots_
std::vector<uint32_t> CpuWalls::listNodes(const CpuStore& store) {
  std::vector<uint32_t> out(cells_.size() * simd::kWallNodes);
  bricks_of_.resize(bodies_.size());
  for (size_t i = 0; i < cells_.size(); ++i) {
    const auto record = [&](uint32_t node, uint32_t slot) {
      out[numberAt(i, node, simd::kWallNodes)] = slot;
      slots_.push_back(slot);
      bricks_of_[i / kWallLanes].push_back(slot / layout::kBrickSlots);
    };
    const uint32_t cell = cells_[i] == kNone ? cells_[i / kWallLanes * kWallLanes] : cells_[i];
    for (uint32_t corner = 0; corner < 8; ++corner) {
      const uint32_t slot = neighborSlot(store.bricks, cell, cornerOffset(corner));
      record(corner, slot);
      for (int axis = 0; axis < 3; ++axis) {
        const uint32_t spring = outward(corner, axis);
        const bool there = isBeyond(store.whole_nodes[slot], spring);
        record(simd::nodeBeyond(corner, axis),
               there ? neighborSlot(store.bricks, slot, kNeighborOffsets[spring]) : slot);
      }
    }
  }
  for (std::vector<uint32_t>& bricks : bricks_of_) sortAndUnite(bricks);
  sortAndUnite(slots_);
  positions_.resize(4 * slots_.size());
  in_wall_.assign(store.brickCount(), 0);
  first_node_.assign(store.brickCount() + 1, 0);
  std::vector<uint32_t> index(store.slotCount());
  for (uint32_t n = 0; n < slots_.size(); ++n) {
    index[slots_[n]] = n;
    in_wall_[slots_[n] / layout::kBrickSlots] = 1;
    ++first_node_[slots_[n] / layout::kBrickSlots + 1];
  }
  for (size_t b = 0; b < store.brickCount(); ++b) first_node_[b + 1] += first_node_[b];
  for (uint32_t& node : out) node = index[node];
  return out;
}

/// Fills listed_ and nodes_.
/// @param nodes  of listNodes()
void CpuWalls::listGroups(const std::vector<uint32_t>& nodes) {
  constexpr size_t kGroup = size_t{simd::kWallNodes} * kWallLanes;
  first_listed_.push_back(0);
  for (size_t g = 0; g < bodies_.size(); ++g) {
    const auto first = nodes.begin() + static_cast<std::ptrdiff_t>(g * kGroup);
    std::vector<uint32_t> once(first, first + kGroup);
    sortAndUnite(once);
    for (size_t i = 0; i < kGroup; ++i) {
      const auto position = std::lower_bound(once.begin(), once.end(), nodes[g * kGroup + i]) - once.begin();
      nodes_.push_back(static_cast<uint16_t>(4 * position));
    }
    for (const uint32_t node : once) listed_.push_back(4 * node);
    first_listed_.push_back(static_cast<uint32_t>(listed_.size()));
  }
  forces_.resize(4 * listed_.size());
}

void CpuWalls::addNumbers(const JoinedMoments& moments, const Strengths& table) {
  const size_t groups = bodies_.size();
  ends_.resize(cells_.size() * simd::kWallEnds);
  moments_.resize(cells_.size() * simd::kMomentNumbers);
  numbers_.resize(cells_.size() * simd::kWallNumbers);
  strengths_.resize(cells_.size() * 2);
  measured_.resize(cells_.size() * 2);
  rows_.resize(cells_.size());
  laminates_.assign(groups, nullptr);
  std::vector<size_t> of_two;
  for (size_t i = 0; i < cells_.size(); ++i) {
    if (cells_[i] == kNone) continue;
    const layout::vec4* wall = moments.wallOf(cells_[i]);
    const float numbers[simd::kWallNumbers] = {wall[0].x, wall[0].y, wall[0].z, 0, 0, 0, wall[0].w, wall[1].x};
    for (uint32_t n = 0; n < simd::kWallNumbers; ++n) numbers_[numberAt(i, n, simd::kWallNumbers)] = numbers[n];
    rows_[i] = wall[0].w;
    const layout::vec4* fill = &moments.vectors[kVectorsPerFill * moments.of_cell[cells_[i]]];
    for (uint32_t n = 0; n < simd::kMomentNumbers; ++n)
      moments_[numberAt(i, n, simd::kMomentNumbers)] = lawMoment(fill, n / 3, n % 3);
    if (moments.laminateOf(cells_[i]) != nullptr && (of_two.empty() || of_two.back() != i / kWallLanes))
      of_two.push_back(i / kWallLanes);
  }
  constexpr size_t kGroup = simd::kLaminateNumbers * kWallLanes;
  laminate_numbers_.resize(of_two.size() * kGroup);
  for (size_t n = 0; n < of_two.size(); ++n) {
    laminates_[of_two[n]] = &laminate_numbers_[n * kGroup];
    for (uint32_t lane = 0; lane < kWallLanes; ++lane) {
      const uint32_t cell = cells_[of_two[n] * kWallLanes + lane];
      const LaminateNumbers of_cell =
          cell == kNone ? LaminateNumbers{1, 0, 0, 1, 1, 1, 2, 2} : laminateNumbers(moments, table, cell);
      for (uint32_t k = 0; k < simd::kLaminateNumbers; ++k)
        laminate_numbers_[n * kGroup + k * kWallLanes + lane] = of_cell[k];
    }
  }
}

/// Fills shares_ and first_share_.
void CpuWalls::addForces() {
  std::vector<std::vector<uint32_t>> of_node(slots_.size());
  for (uint32_t n = 0; n < listed_.size(); ++n) of_node[listed_[n] / 4].push_back(4 * n);
  first_share_.push_back(0);
  for (const std::vector<uint32_t>& shares : of_node) {
    shares_.insert(shares_.end(), shares.begin(), shares.end());
    first_share_.push_back(static_cast<uint32_t>(shares_.size()));
  }
}

void CpuWalls::refresh(const CpuStore& store, uint32_t cell, float rigidity_j, float bulk_j) {
  const uint32_t i = position_[cell];
  strengths_[numberAt(i, 0, 2)] = rigidity_j;
  strengths_[numberAt(i, 1, 2)] = rigidity_j > 0 ? bulk_j / rigidity_j : 0;
  for (int axis = 0; axis < 3; ++axis) {
    bool any = false;
    for (int side = 0; side < 2; ++side) {
      for (int other = 0; other < 2; ++other) {
        const uint32_t a = simd::lowerCorner(axis, side, other), b = simd::upperCorner(axis, side, other);
        const bool low = isWithinRow(store.nodes[neighborSlot(store.bricks, cell, cornerOffset(a))], axis);
        const bool high = isWithinRow(store.nodes[neighborSlot(store.bricks, cell, cornerOffset(b))], axis);
        const uint32_t at = simd::endsAt(axis, side, other);
        ends_[numberAt(i, at, simd::kWallEnds)] = low ? (high ? 1.0f : 2.0f) : 0.0f;
        ends_[numberAt(i, at + 1, simd::kWallEnds)] = high ? (low ? 1.0f : 2.0f) : 0.0f;
        any = any || low || high;
      }
    }
    numbers_[numberAt(i, static_cast<uint32_t>(3 + axis), simd::kWallNumbers)] = any ? rows_[i] : 0;
  }
}

simd::WallGroups CpuWalls::groups() {
  return {bodies_.data(),    first_listed_.data(), listed_.data(),  nodes_.data(),
          ends_.data(),      moments_.data(),      numbers_.data(), strengths_.data(),
          laminates_.data(), positions_.data(),    forces_.data(),  measured_.data()};
}

std::vector<uint32_t> CpuWalls::acting(const std::vector<uint32_t>& bricks) const {
  std::vector<uint32_t> out;
  if (empty()) return out;
  std::vector<uint8_t> wanted(in_wall_.size(), 0);
  for (const uint32_t brick : bricks) wanted[brick] = 1;
  for (uint32_t group = 0; group < bricks_of_.size(); ++group) {
    const std::vector<uint32_t>& of_group = bricks_of_[group];
    if (std::any_of(of_group.begin(), of_group.end(), [&](uint32_t brick) { return wanted[brick] != 0; }))
      out.push_back(group);
  }
  return out;
}

std::vector<uint32_t> CpuWalls::seen(const std::vector<uint32_t>& groups) const {
  std::vector<uint32_t> out;
  for (const uint32_t group : groups) out.insert(out.end(), bricks_of_[group].begin(), bricks_of_[group].end());
  sortAndUnite(out);
  return out;
}

void CpuWalls::place(uint32_t brick, const layout::BodyParams& body, const float* displacement, const float* velocity,
                     float ahead_s) {
  const float scale = 0.25f / body.origin_spacing.w, ahead = scale * ahead_s;
  for (uint32_t n = first_node_[brick]; n < first_node_[brick + 1]; ++n) {
    const size_t at = vectorAt(slots_[n]);
    for (size_t c = 0; c < 3; ++c) {
      const float u = scale * displacement[at + 64 * c];
      positions_[4 * n + c] = ahead_s == 0 ? u : u + ahead * velocity[at + 64 * c];
    }
  }
}

void CpuWalls::sumForces(uint32_t brick, const Vector3f& gravity, float* out) const {
  for (uint32_t n = first_node_[brick]; n < first_node_[brick + 1]; ++n) {
    const Vector3f lifted = -ghosts_kg_[n] * gravity;
    float sum[4] = {lifted.x(), lifted.y(), lifted.z(), 0};
    for (uint32_t s = first_share_[n]; s < first_share_[n + 1]; ++s) {
      const float* force = &forces_[shares_[s]];
      for (size_t c = 0; c < 4; ++c) sum[c] += force[c];
    }
    float* to = out + vectorAt(slots_[n]);
    for (size_t c = 0; c < 3; ++c) to[64 * c] = sum[c];
  }
}

std::array<float, 2> CpuWalls::measured(uint32_t brick) const {
  double energy_j = 0;
  float stiffening = 0;
  for (const uint32_t i : cells_of_[brick]) {
    energy_j += static_cast<double>(measured_[numberAt(i, 0, 2)]);
    stiffening = std::max(stiffening, measured_[numberAt(i, 1, 2)]);
  }
  return {static_cast<float>(energy_j), stiffening};
}

}  // namespace viscera
