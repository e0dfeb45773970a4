// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/state/sleep.h"

#include <algorithm>
#include <cmath>

#include "math/archive.h"

namespace viscera {

namespace {

constexpr size_t kBrickFloats3 = 3 * size_t{layout::kBrickSlots};

float largestDisplacement(const CpuLattice& lattice, uint32_t brick) {
  const float* u = &lattice.state.displacement[lattice.state.current][brick * kBrickFloats3];
  float largest2 = 0;
  for (size_t i = 0; i < layout::kBrickSlots; ++i) {
    largest2 = std::max(largest2, u[i] * u[i] + u[i + 64] * u[i + 64] + u[i + 128] * u[i + 128]);
  }
  return std::sqrt(largest2);
}

/// Returns false for bodies with explicit connections: these are not stepped brick by brick (network.h).
bool isImplicit(const CpuLattice& lattice, uint32_t brick) {
  return lattice.store.bodies[lattice.store.bricks[brick].body].connections == layout::kImplicit;
}

}  // namespace

Sleep::Sleep(const CpuLattice& lattice, double speed_m_per_s)
    : speed2_(static_cast<float>(speed_m_per_s * speed_m_per_s)),
      substeps_between_checks_(lattice.strengths.walls.empty() ? kSubsteps : kSubstepsWithWalls),
      quiet_s_(lattice.brickCount()),
      farthest_m_(lattice.brickCount()),
      moves_(lattice.brickCount()),
      is_awake_(lattice.brickCount()),
      wanted_(lattice.brickCount()),
      changed_(lattice.brickCount()) {
  awake_.reserve(lattice.brickCount());
  wakeAll(lattice);
}

void Sleep::wakeAll(const CpuLattice& lattice) {
  awake_.clear();
  std::fill(changed_.begin(), changed_.end(), uint8_t{1});
  for (uint32_t b = 0; b < lattice.brickCount(); ++b) {
    const float* mobility = &lattice.strengths.mobility[size_t{b} * layout::kBrickSlots];
    moves_[b] = isImplicit(lattice, b) &&
                std::any_of(mobility, mobility + layout::kBrickSlots, [](float value) { return value > 0; });
    is_awake_[b] = moves_[b];
    quiet_s_[b] = 0;
    if (moves_[b]) awake_.push_back(b);
  }
  moving_bricks_ = awake_.size();
}

void Sleep::wake(uint32_t brick) {
  quiet_s_[brick] = 0;
  if (is_awake_[brick] || !moves_[brick]) return;
  is_awake_[brick] = 1;
  awake_.insert(std::lower_bound(awake_.begin(), awake_.end(), brick), brick);
}

void Sleep::wakeNear(const CpuLattice& lattice, const Vector3f& low, const Vector3f& high) {
  for (uint32_t b = 0; b < lattice.brickCount(); ++b) {
    if (is_awake_[b] && quiet_s_[b] == 0) continue;
    const layout::Brick& brick = lattice.store.bricks[b];
    const layout::vec4& origin = lattice.store.bodies[brick.body].origin_spacing;
    const float edge = static_cast<float>(layout::kBrickEdge) * origin.w;
    const Vector3f first = Vector3f(origin.x, origin.y, origin.z) + edge * Vector3f(static_cast<float>(brick.coord_x),
                                                                                    static_cast<float>(brick.coord_y),
                                                                                    static_cast<float>(brick.coord_z));
    const Vector3f reach = Vector3f::Constant(is_awake_[b] ? largestDisplacement(lattice, b) : farthest_m_[b]);
    const Vector3f last = first + Vector3f::Constant(edge - origin.w) + reach;
    if (((first - reach).array() <= high.array()).all() && (last.array() >= low.array()).all()) wake(b);
  }
}

void Sleep::takeChanged(const CpuLattice& lattice, std::vector<uint32_t>& out) {
  for (uint32_t b : awake_) {
    for (uint32_t neighbor : lattice.store.bricks[b].neighbors) changed_[neighbor] = 1;
  }
  out.clear();
  for (uint32_t b = 0; b < changed_.size(); ++b) {
    if (changed_[b] && isImplicit(lattice, b)) out.push_back(b);
    changed_[b] = 0;
  }
}

void Sleep::persist(Archive& archive) {
  archive.values(quiet_s_);
  archive.values(farthest_m_);
  archive.values(moves_);
  archive.values(is_awake_);
  archive.values(changed_);
  archive.list(awake_);
  archive.value(moving_bricks_);
  archive.value(since_check_s_);
  archive.value(substeps_since_check_);
  if (archive.reads()) requireListed(archive);
}

/// Checks that flags are 0 or 1 and that the list holds exactly the awake bricks.
/// @throws Error
void Sleep::requireListed(const Archive& archive) const {
  std::vector<uint32_t> listed;
  for (uint32_t b = 0; b < is_awake_.size(); ++b) {
    const bool flags = moves_[b] <= 1 && is_awake_[b] <= 1 && changed_[b] <= 1;
    if (!flags) archive.require(false, "brick " + std::to_string(b) + " has a flag that is neither 0 nor 1");
    if (is_awake_[b]) listed.push_back(b);
  }
  archive.require(listed == awake_, "the list of awake bricks differs from the marked ones");
  archive.require(substeps_since_check_ >= 0 && substeps_since_check_ < substeps_between_checks_,
                  std::to_string(substeps_since_check_) + " substeps since the last check; 0 .. " +
                      std::to_string(substeps_between_checks_ - 1) + " are accepted");
}

void Sleep::restart() {
  since_check_s_ = 0;
  substeps_since_check_ = 0;
}

void Sleep::passed(CpuLattice& lattice, float dt_s, const std::vector<float>& speed2) {
  since_check_s_ += static_cast<double>(dt_s);
  if (++substeps_since_check_ < substeps_between_checks_) return;
  if (!awake_.empty()) check(lattice, speed2);
  restart();
}

void Sleep::check(CpuLattice& lattice, const std::vector<float>& speed2) {
  if (speed2_ <= 0) return;
  size_t restless = 0;
  for (uint32_t b : awake_) {
    // The negation makes NaN count as fast.
    quiet_s_[b] = !(speed2[b] <= speed2_) ? 0 : quiet_s_[b] + static_cast<float>(since_check_s_);
    restless += quiet_s_[b] < kQuiet_s;
  }
  if (restless < moving_bricks_) list(lattice);
}

void Sleep::list(CpuLattice& lattice) {
  std::fill(wanted_.begin(), wanted_.end(), uint8_t{0});
  for (uint32_t b : awake_) {
    if (quiet_s_[b] >= kQuiet_s) continue;
    for (uint32_t neighbor : lattice.store.bricks[b].neighbors) wanted_[neighbor] = 1;
  }
  for (uint32_t b : awake_) {
    if (!wanted_[b]) freeze(lattice, b);
  }
  awake_.clear();
  for (uint32_t b = 0; b < wanted_.size(); ++b) {
    const bool wanted = wanted_[b] && moves_[b];
    // A brick that only a neighbour woke does not wake others before it moves.
    if (wanted && !is_awake_[b]) quiet_s_[b] = static_cast<float>(kQuiet_s);
    is_awake_[b] = wanted;
    if (wanted) awake_.push_back(b);
  }
}

void Sleep::freeze(CpuLattice& lattice, uint32_t brick) {
  const size_t first = brick * kBrickFloats3;
  const float* now = &lattice.state.displacement[lattice.state.current][first];
  std::copy(now, now + kBrickFloats3, &lattice.state.displacement[1 - lattice.state.current][first]);
  for (AlignedVector<float>& velocity : lattice.state.velocity) {
    std::fill(&velocity[first], &velocity[first] + kBrickFloats3, 0.0f);
  }
  farthest_m_[brick] = largestDisplacement(lattice, brick);
  for (uint32_t neighbor : lattice.store.bricks[brick].neighbors) changed_[neighbor] = 1;
}

}  // namespace viscera
