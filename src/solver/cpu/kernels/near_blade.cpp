// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/kernels/near_blade.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "layout/blade.h"
#include "solver/cpu/kernels/glsl.h"
#include "solver/cpu/kernels/glsl_features.h"

namespace viscera {

namespace glsl {

namespace {

struct NoKernel {};

#define VARIANT_NAME Blade
#define VARIANT_BASE NoKernel
#define VARIANT_TEXT "shaders/solver/tools/blade.glsl"
#include "solver/cpu/kernels/glsl_variant.inc"

}  // namespace

}  // namespace glsl

namespace {

/// In cells: largest distance between a node and its position as used by cuts (kSway and kBeside in
/// shaders/solver/tools/cut_sides.glsl).
constexpr float kFarthestSway = 0.51f;

constexpr uint8_t kNotNear = 255;

/// Returns the unit vector along the part of v that is perpendicular to the unit vector n; any perpendicular vector if
/// that part is 0.
glsl::vec3 acrossOf(const glsl::vec3& n, const glsl::vec3& v) {
  const glsl::vec3 across = v - glsl::dot(n, v) * n;
  if (glsl::dot(across, across) > 1e-12f * glsl::dot(v, v)) return glsl::normalize(across);
  const glsl::vec3 other = glsl::abs(n.x) < 0.5f ? glsl::vec3(1, 0, 0) : glsl::vec3(0, 1, 0);
  return glsl::normalize(glsl::cross(n, other));
}

void write(const glsl::vec3& v, float* to) {
  for (int k = 0; k < 3; ++k) to[k] = v[k];
}

/// Sets the sphere around everything that the blade may cut.
/// @param reach_m  largest distance of a node's tissue from the node
void surround(const glsl::vec4& sphere, float reach_m, simd::Sweep& sweep) {
  write(glsl::xyz(sphere), sweep.center_m);
  sweep.radius_m = sphere.w + reach_m;
}

/// Sets the box around the swept blade, along the blade and its motion.
void box(const layout::ToolMotion& m, float grown_m, simd::Sweep& sweep) {
  const glsl::vec3 from = glsl::xyz(m.from), tip = glsl::xyz(m.to) - from;
  const glsl::vec3 far_from = glsl::xyz(m.blade_from) - from, far_to = glsl::xyz(m.blade_to) - from;
  glsl::vec3 axes[3];
  axes[0] = glsl::dot(far_from, far_from) > 0 ? glsl::normalize(far_from) : glsl::vec3(0, 0, 1);
  axes[1] = acrossOf(axes[0], tip + (far_to - far_from));
  axes[2] = glsl::cross(axes[0], axes[1]);
  for (int k = 0; k < 3; ++k) {
    write(axes[k], sweep.axes[k]);
    const float a = glsl::dot(axes[k], tip), b = glsl::dot(axes[k], far_from), c = glsl::dot(axes[k], far_to);
    sweep.low_m[k] = glsl::min(glsl::min(0.0f, a), glsl::min(b, c)) - grown_m;
    sweep.high_m[k] = glsl::max(glsl::max(0.0f, a), glsl::max(b, c)) + grown_m;
  }
}

/// Returns the sides of the box beyond which all positions of a brick are, with their tissue.
uint8_t sidesBeyond(const simd::Sweep& sweep, const simd::BrickPositions& positions, float reach_m) {
  int sides = 0;  // positions that are not finite are beyond none
  for (int k = 0; k < 3; ++k) {
    float middle = 0, half = reach_m;
    for (int c = 0; c < 3; ++c) {
      middle += sweep.axes[k][c] * 0.5f * (positions.low_m[c] + positions.high_m[c]);
      half += std::abs(sweep.axes[k][c]) * 0.5f * (positions.high_m[c] - positions.low_m[c]);
    }
    sides |= (middle + half < sweep.low_m[k]) << (2 * k) | (middle - half > sweep.high_m[k]) << (2 * k + 1);
  }
  return static_cast<uint8_t>(sides);
}

// Bytes of the slots of a brick and around it: rows of eight along x, of which six are used, from y, z = -1 on.
using ByteRows = uint64_t[6][6];
constexpr uint64_t kLowBits = 0x7f7f7f7f7f7f7f7f;

/// Returns row (y, z) of the bytes around a brick.
/// @param neighbors  as in layout::Brick
uint64_t rowOf(const uint8_t* bytes, const layout::uint* neighbors, int y, int z) {
  const int side = 3 * (y < 0 ? 0 : y > 3 ? 2 : 1) + 9 * (z < 0 ? 0 : z > 3 ? 2 : 1);
  const size_t at = static_cast<size_t>(4 * (y & 3) + 16 * (z & 3));
  uint32_t own;
  std::memcpy(&own, bytes + neighbors[side + 1] * size_t{layout::kBrickSlots} + at, 4);
  const uint64_t before = bytes[neighbors[side] * size_t{layout::kBrickSlots} + at + 3];
  const uint64_t after = bytes[neighbors[side + 2] * size_t{layout::kBrickSlots} + at];
  return before | uint64_t{own} << 8 | after << 40;
}

/// Returns the highest bit of each byte that is 0.
uint64_t zeroBytes(uint64_t v) {
  return ~(((v & kLowBits) + kLowBits) | v | kLowBits);
}

/// Returns the bits of the four slots of a row with a spring between ends that have no side in common.
uint64_t rowThatMayLose(const ByteRows& rows, int y, int z) {
  const uint64_t own = rows[z][y];
  uint64_t may = 0;  // in the highest bit of bytes 1 to 4
  for (int dz = -1; dz <= 1; ++dz) {
    for (int dy = -1; dy <= 1; ++dy) {
      const uint64_t other = rows[z + dz][y + dy];
      if (dy != 0 || dz != 0) may |= zeroBytes(own & other);
      if (dy == 0 || dz == 0) may |= zeroBytes(own & other << 8) | zeroBytes(own & other >> 8);
    }
  }
  uint64_t bits = 0;
  for (int x = 0; x < 4; ++x) bits |= (may >> (8 * (x + 1) + 7) & 1) << x;
  return bits;
}

}  // namespace

NearBlade::NearBlade(const CpuLattice& lattice, std::vector<float> reach_m, const Parallel& parallel,
                     const simd::Kernels& kernels)
    : parallel_(parallel),
      find_positions_(kernels.sweep),
      find_sides_(kernels.sides),
      reach_m_(std::move(reach_m)),
      farthest_m_(lattice.brickCount()),
      sweeps_(lattice.store.bodies.size()),
      positions_(lattice.brickCount()),
      outside_(lattice.slotCount(), kNotNear),
      common_(lattice.brickCount(), kNotNear),
      nodes_(lattice.brickCount(), 0) {
  near_.reserve(lattice.brickCount());
  for (size_t slot = 0; slot < reach_m_.size(); ++slot) {
    float& farthest = farthest_m_[slot / layout::kBrickSlots];
    farthest = std::max(farthest, reach_m_[slot]);
  }
}

/// Clears the result, as if nothing had been near.
void NearBlade::clear() {
  for (uint32_t b : near_) {
    common_[b] = kNotNear;
    std::fill_n(&outside_[b * layout::kBrickSlots], layout::kBrickSlots, kNotNear);
  }
  near_.clear();
}

/// Returns whether a brick may have a position within the sphere that the blade may cut in.
bool NearBlade::isNearAtRest(const CpuLattice& lattice, uint32_t b) const {
  const layout::Brick& brick = lattice.store.bricks[b];
  const layout::vec4& origin = lattice.store.bodies[brick.body].origin_spacing;
  const simd::Sweep& sweep = sweeps_[brick.body];
  const glsl::vec3 coord(static_cast<float>(brick.coord_x), static_cast<float>(brick.coord_y),
                         static_cast<float>(brick.coord_z));
  const glsl::vec3 first = glsl::xyz(origin) + static_cast<float>(layout::kBrickEdge) * origin.w * coord;
  const glsl::vec3 last = first + static_cast<float>(layout::kBrickEdge - 1) * origin.w;
  float far2 = 0;
  for (int k = 0; k < 3; ++k) {
    const float at = job_.from_m[k] + sweep.center_m[k], off = at - glsl::clamp(at, first[k], last[k]);
    far2 += off * off;
  }
  const float radius_m = sweep.radius_m + simd::kSweepMargin * origin.w;
  return far2 <= radius_m * radius_m;
}

void NearBlade::findBricks(const CpuLattice& lattice, const layout::ToolMotion& motion, bool at_rest) {
  job_ = {lattice.store.bricks.data(),
          lattice.store.bodies.data(),
          lattice.state.displacement[lattice.state.current].data(),
          lattice.state.velocity[lattice.state.current].data(),
          reach_m_.data(),
          {motion.from.x, motion.from.y, motion.from.z},
          sweeps_.data(),
          positions_.data(),
          outside_.data()};
  const size_t count = lattice.brickCount();
  for (uint32_t b = 0; at_rest && b < count; ++b) {
    positions_[b].near = 0;
    if (isNearAtRest(lattice, b)) find_positions_(job_, b, b + 1);
  }
  parallel_(at_rest ? 0 : (count + kBricksPerJob - 1) / kBricksPerJob,
            [&](size_t i) { find_positions_(job_, i * kBricksPerJob, std::min(count, (i + 1) * kBricksPerJob)); });
  for (uint32_t b = 0; b < count; ++b) {
    if (positions_[b].near) near_.push_back(b);
  }
}

/// Returns the largest offset of the sweep's start, as springs of near bricks see it [m] (startOffset in blade.glsl).
float NearBlade::farthestOffset(const layout::ToolMotion& motion) const {
  float most2 = 0;
  for (uint32_t b : near_) most2 = std::max(most2, positions_[b].speed2);
  const float overlap = layout::kOverlap * glsl::distance(glsl::xyz(motion.to), glsl::xyz(motion.from));
  return (1 + simd::kSweepMargin) * (motion.timing.x * std::sqrt(most2) + overlap);
}

void NearBlade::placeBrick(uint32_t b) {
  const simd::Sweep& sweep = sweeps_[job_.bricks[b].body];
  uint8_t* const out = &outside_[b * layout::kBrickSlots];
  common_[b] = sidesBeyond(sweep, positions_[b], farthest_m_[b]);
  if (common_[b] != 0)
    std::fill_n(out, layout::kBrickSlots, common_[b]);
  else
    find_sides_(job_, &b, 1);
}

/// Returns whether a spring of the brick's nodes may cross the box: not if all positions in it and around it are beyond
/// the same side.
bool NearBlade::mayCross(const layout::Brick& brick) const {
  uint8_t common = kNotNear;
  for (uint32_t neighbor : brick.neighbors) common &= common_[neighbor];
  return common == 0;
}

uint64_t NearBlade::nodesThatMayLose(const layout::Brick& brick) const {
  if (!mayCross(brick)) return 0;
  ByteRows rows;
  for (int z = -1; z <= 4; ++z) {
    for (int y = -1; y <= 4; ++y) rows[z + 1][y + 1] = rowOf(outside_.data(), brick.neighbors, y, z);
  }
  uint64_t nodes = 0;
  for (int z = 0; z < 4; ++z) {
    for (int y = 0; y < 4; ++y) nodes |= rowThatMayLose(rows, y + 1, z + 1) << (16 * z + 4 * y);
  }
  return nodes;
}

void NearBlade::find(const CpuLattice& lattice, const layout::ToolMotion& motion, bool particles, bool at_rest) {
  clear();
  for (size_t body = 0; body < sweeps_.size(); ++body) {
    const float h = lattice.store.bodies[body].origin_spacing.w;
    const bool beside = !lattice.strengths.surface_offsets.empty();
    surround(glsl::Blade().bladeSphere(motion, h), beside ? layout::kFarthestTissue * h : 0, sweeps_[body]);
  }
  findBricks(lattice, motion, at_rest);
  const float grown_m = particles ? motion.blade_from.w : farthestOffset(motion);
  for (size_t body = 0; body < sweeps_.size(); ++body) {
    const float h = lattice.store.bodies[body].origin_spacing.w;
    const float sphere_m = glsl::Blade().bladeSphere(motion, h).w;
    box(motion, grown_m + kFarthestSway * h + simd::kSweepMargin * sphere_m, sweeps_[body]);
  }
  forEachNear([&](uint32_t b) { placeBrick(b); });
  forEachNear([&](uint32_t b) { nodes_[b] = nodesThatMayLose(lattice.store.bricks[b]); });
}

}  // namespace viscera
