// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/steps/leapfrog.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "math/archive.h"
#include "solver/cpu/kernels/tool_passes.h"
#include "solver/cpu/state/lattice_arrays.h"

namespace viscera {

namespace {

constexpr size_t kMostBricks = 16;  // bricks that a thread takes at a time: about 10 us of work
constexpr size_t kLeastBricks = 2;  // towards the end of a round: about 1 us, still ten times the cost of taking them
constexpr size_t kPartsPerThread = 8;  // at least, given enough bricks: an idle thread takes the next part

float distanceOf(const layout::vec4& a, const layout::vec4& b) {
  return Vector3f(a.x - b.x, a.y - b.y, a.z - b.z).norm();
}

/// Calls visit with the reach of each probe and shaft in a substep, around its final position.
/// @param margin_m  largest depth of a node below the surface at which it is touched, and largest distance of a
/// spring's node from the probe (edgeReach())
template <class Visit>
void forEachReach(const layout::ToolMotion* motions, float margin_m, const Visit& visit) {
  for (size_t s = 0; s < layout::kMaxStyluses; ++s) {
    const layout::ToolMotion& m = motions[s];
    if (m.info.y & layout::kToolPushes)
      visit(simd::Reach{{m.to.x, m.to.y, m.to.z}, m.from.w + margin_m + distanceOf(m.to, m.from), {}, 0});
    if (!(m.info.y & layout::kToolShaft)) continue;
    const layout::vec4 &near = m.shaft_to, &far = m.shaft_far_to;
    const float length_m = distanceOf(near, far);
    const float travel_m = std::max(distanceOf(near, m.shaft_from), distanceOf(far, m.shaft_far_from));
    visit(simd::Reach{{near.x, near.y, near.z},
                      m.shaft_from.w + margin_m + travel_m,
                      {far.x - near.x, far.y - near.y, far.z - near.z},
                      1 / (length_m * length_m)});
  }
}

float deepestOf(const std::vector<float>& depths_m) {
  return depths_m.empty() ? 0 : std::max(0.0f, *std::max_element(depths_m.begin(), depths_m.end()));
}

}  // namespace

CpuLeapfrog::CpuLeapfrog(const CpuLattice& lattice, const CpuParts& parts)
    : parallel_(parts.parallel),
      sleep_(parts.sleep),
      network_(parts.network),
      dashpot_(parts.features.dashpot),
      step_bricks_(parts.kernels.leapfrog),
      predict_bricks_(parts.kernels.predict),
      sum_cells_(parts.kernels.cells),
      sum_walls_(parts.kernels.walls),
      deepest_m_(deepestOf(lattice.strengths.surface_depth)),
      near_(lattice.brickCount()),
      strained_(lattice.brickCount()),
      speed2_(lattice.brickCount()),
      edges_(parts.features.tools ? lattice.slotCount() : 0) {
  if (parts.features.compensated) compensation_.resize(6 * lattice.slotCount());
  if (parts.features.law) {
    cell_sums_.resize(simd::kCellSums * lattice.brickCount());
    wanted_.resize(lattice.brickCount());
    cell_bricks_.reserve(lattice.brickCount());
    cell_bricks_awake_.reserve(lattice.brickCount());
  }
  if (!lattice.strengths.walls.empty()) wall_forces_.resize(3 * lattice.slotCount());
  if (network_) reaches_.reserve(simd::kMostReaches);
  if (parts.features.predicted) {
    predicted_.resize(3 * lattice.slotCount());
    all_bricks_.resize(lattice.brickCount());
    std::iota(all_bricks_.begin(), all_bricks_.end(), 0u);
    predicted_awake_.reserve(lattice.brickCount());
  }
  job_.near = near_.data();
  job_.strained = strained_.data();
  job_.speed2 = speed2_.data();
}

void CpuLeapfrog::restart() {
  std::fill(compensation_.begin(), compensation_.end(), 0.0f);
  clearSums();
}

/// Clears the sums. Planes of nodes on which no cell acts are never written, and an external write to the state may
/// change which these are.
void CpuLeapfrog::clearSums() {
  std::fill(cell_sums_.begin(), cell_sums_.end(), 0.0f);
}

void CpuLeapfrog::persist(Archive& archive, CpuLattice& /*lattice*/) {
  archive.values(compensation_);
  archive.values(near_);
  archive.values(strained_);
  archive.values(speed2_);
  if (archive.reads()) clearSums();
}

void CpuLeapfrog::run(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions) {
  if (!sleep_.awake().empty()) stepAwake(lattice, step, motions);
  if (network_) stepNetwork(lattice, step, motions);
  edges_.run(lattice, step, motions);
  sleep_.passed(lattice, step.dt_s, speed2_);
}

/// Steps the awake bricks.
void CpuLeapfrog::stepAwake(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions) {
  const size_t awake = sleep_.awake().size();
  const size_t fair = awake / (kPartsPerThread * static_cast<size_t>(parallel_.threads()));
  portions_.most = std::clamp<size_t>(fair, 1, kMostBricks);
  portions_.least = std::min(portions_.most, kLeastBricks);
  job_.arrays = arraysOf(lattice);
  if (!cell_sums_.empty()) {
    sumCells(lattice);
    job_.arrays.cell_sums = cell_sums_.data();
    if (!wall_groups_.empty()) sumWalls(lattice, step);
  }
  job_.arrays.compensation = compensation_.empty() ? nullptr : compensation_.data();
  job_.step = step;
  if (!predicted_.empty()) predict(step);
  job_.reaches = 0;
  if (step.tools) {
    forEachReach(motions, deepest_m_ + step.edge_reach_m,
                 [&](const simd::Reach& reach) { job_.reach[job_.reaches++] = reach; });
  }
  parallel_.ranges(awake, portions_, [&](size_t first, size_t end) { stepBricks(lattice, step, motions, first, end); });
  if (!step.tools) return;
  const std::vector<uint32_t>& first = lattice.store.first_active;
  for (const uint32_t brick : sleep_.awake()) {
    if (!near_[brick]) continue;
    near_[brick] = 0;
    edges_.add(lattice, step, motions, &lattice.store.active[first[brick]], first[brick + 1] - first[brick]);
  }
}

/// Predicts the displacements of bricks. Sleeping bricks do not move, so their prediction holds while the same bricks
/// are awake, unless the state was written from outside.
void CpuLeapfrog::predict(const Substep& step) {
  const std::vector<uint32_t>& awake = sleep_.awake();
  const bool whole = step.restarted || step.index == 0 || predicted_awake_ != awake;
  if (whole) predicted_awake_ = awake;
  const std::vector<uint32_t>& bricks = whole ? all_bricks_ : awake;
  job_.predicted = predicted_.data();
  parallel_.ranges(bricks.size(), portions_,
                   [&](size_t first, size_t end) { predict_bricks_(job_, &bricks[first], end - first); });
}

/// Sums the forces of all cells with a corner in an awake brick: those of the brick itself and of the seven below it.
void CpuLeapfrog::sumCells(CpuLattice& lattice) {
  if (cell_bricks_awake_ != sleep_.awake()) {
    cell_bricks_awake_ = sleep_.awake();
    std::fill(wanted_.begin(), wanted_.end(), uint8_t{0});
    for (const uint32_t brick : cell_bricks_awake_) {
      for (const int direction : {0, 1, 3, 4, 9, 10, 12, 13})
        wanted_[lattice.store.bricks[brick].neighbors[direction]] = 1;
    }
    cell_bricks_.clear();
    for (uint32_t b = 0; b < wanted_.size(); ++b) {
      const bool of_law = lattice.store.bodies[lattice.store.bricks[b].body].law != layout::kLawSprings;
      if (wanted_[b] && of_law) cell_bricks_.push_back(b);
    }
    wall_groups_ = lattice.strengths.walls.acting(cell_bricks_awake_);
    wall_bricks_ = lattice.strengths.walls.seen(wall_groups_);
  }
  simd::CellJob job = cellsOf(lattice);
  job.dashpot = dashpot_;
  job.sums = cell_sums_.data();
  parallel_.ranges(cell_bricks_.size(), portions_,
                   [&](size_t first, size_t end) { sum_cells_(job, &cell_bricks_[first], end - first); });
}

/// Sums the forces of cells in thin walls on the nodes of awake bricks.
void CpuLeapfrog::sumWalls(CpuLattice& lattice, const Substep& step) {
  CpuWalls& walls = lattice.strengths.walls;
  parallel_.ranges(wall_bricks_.size(), portions_, [&](size_t first, size_t end) {
    for (size_t i = first; i < end; ++i) {
      const layout::BodyParams& body = lattice.store.bodies[lattice.store.bricks[wall_bricks_[i]].body];
      walls.place(wall_bricks_[i], body, job_.arrays.displacement, job_.arrays.velocity, dashpot_ ? body.dashpot_s : 0);
    }
  });
  const simd::WallJob job{lattice.store.bodies.data(), walls.groups()};
  parallel_.ranges(wall_groups_.size(), portions_,
                   [&](size_t first, size_t end) { sum_walls_(job, &wall_groups_[first], end - first); });
  const std::vector<uint32_t>& awake = sleep_.awake();
  parallel_.ranges(awake.size(), portions_, [&](size_t first, size_t end) {
    for (size_t i = first; i < end; ++i) walls.sumForces(awake[i], step.gravity, wall_forces_.data());
  });
  job_.arrays.wall_forces = wall_forces_.data();
  job_.arrays.in_wall = walls.inWall();
}

void CpuLeapfrog::stepBricks(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions, size_t first,
                             size_t end) {
  const std::vector<uint32_t>& awake = sleep_.awake();
  step_bricks_(job_, &awake[first], end - first);
  if (!step.tools) return;
  for (size_t i = first; i < end; ++i) {
    const uint32_t brick = awake[i];
    if (!near_[brick] && !lattice.tools.held[brick]) continue;
    touch(lattice, step, motions, brick);
  }
}

/// Applies tools to the nodes of a brick in the substep.
void CpuLeapfrog::touch(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions, uint32_t brick) {
  const uint32_t first = lattice.store.first_active[brick], end = lattice.store.first_active[brick + 1];
  resolveContacts(lattice, step, motions, &lattice.store.active[first], end - first);
  speed2_[brick] = std::numeric_limits<float>::infinity();  // keeps it awake
}

/// Steps the nodes with explicit connections.
void CpuLeapfrog::stepNetwork(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions) {
  network_->step(lattice, step, compensation_);
  if (!step.tools) return;
  reaches_.clear();
  forEachReach(motions, deepest_m_ + step.edge_reach_m, [&](const simd::Reach& reach) { reaches_.push_back(reach); });
  const std::vector<uint32_t>& touched = network_->touched(lattice, reaches_);
  resolveContacts(lattice, step, motions, touched.data(), touched.size());
  edges_.add(lattice, step, motions, touched.data(), touched.size());
}

}  // namespace viscera
