// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/follow/state_mirror.h"

#include <algorithm>
#include <cassert>
#include <cstring>

#include "gpu/stage_clock.h"
#include "solver/tissue/joined_lattice.h"
#include "solver/tissue/joined_network.h"
#include "surface/skins/joined_skins.h"
#include "viscera/solver/material.h"

namespace viscera {

StateMirror::StateMirror(const Model& model)
    : bricks_(allBricks(model)),
      shown_(viscera::shownBricks(model)),
      positions_(bricks_.size()),
      known_m_(kBrickFloats * shown_.size()),
      stale_(bricks_.size(), revision_),
      displacement_(model.slots(), "shown displacement"),
      nodes_(allNodes(model), "shown nodes"),
      brick_buffer_(bricks_, "shown bricks"),
      bodies_(layout::kMaxBodies),
      stale_buffer_(stale_) {
  for (uint32_t i = 0; i < shown_.size(); ++i) positions_[shown_[i]] = i;
  run_.reserve(layout::kBrickSlots * shown_.size());
  bodies_.write(bodyParams(model, 0));  // kernels here read only places and spacings
  if (!model.hasNetwork()) return;
  const JoinedNetwork network = joinNetworks(model);
  rest_ = gpu::Buffer<layout::vec4>(network.rest_m, "rest");
  spring_cut_ = gpu::Buffer<float>(network.springs.size(), "spring cut");
}

void StateMirror::upload(const StateSnapshot& snapshot) {
  assert(snapshot.bricks == shown_ && snapshot.displacement_m.size() == known_m_.size());
  const gpu::TimedStage timed(gpu::Stage::kUpload);
  ++revision_;
  uploadMoved(snapshot);
  if (snapshot.cut_revision != cut_revision_) {
    cut_revision_ = snapshot.cut_revision;
    nodes_.write(snapshot.nodes);
    assert(snapshot.spring_cut.size() == spring_cut_.size());
    spring_cut_.write(snapshot.spring_cut);
    std::fill(stale_.begin(), stale_.end(), revision_);  // normals depend on springs
    moved_revision_ = revision_;
  }
  if (moved_revision_ == revision_) stale_buffer_.write(stale_);
}

void StateMirror::uploadMoved(const StateSnapshot& snapshot) {
  for (size_t i = 0; i < shown_.size(); ++i) {
    if (!hasMoved(snapshot, i)) continue;
    if (shown_[i] != run_end_) flush();
    take(snapshot, i);
    for (uint32_t beside : bricks_[shown_[i]].neighbors) stale_[beside] = revision_;  // and the brick itself
    moved_revision_ = revision_;
    ++moved_bricks_;
  }
  flush();
}

bool StateMirror::hasMoved(const StateSnapshot& snapshot, size_t index) const {
  const size_t first = kBrickFloats * index;
  return std::memcmp(&snapshot.displacement_m[first], &known_m_[first], kBrickFloats * sizeof(float)) != 0;
}

/// Appends a brick to the run.
void StateMirror::take(const StateSnapshot& snapshot, size_t index) {
  if (run_.empty()) run_begin_ = run_end_ = shown_[index];
  const float* const u = &snapshot.displacement_m[kBrickFloats * index];
  std::copy_n(u, kBrickFloats, &known_m_[kBrickFloats * index]);
  for (size_t slot = 0; slot < layout::kBrickSlots; ++slot) {
    run_.push_back({u[slot], u[layout::kBrickSlots + slot], u[2 * layout::kBrickSlots + slot], 0});
  }
  ++run_end_;
}

void StateMirror::flush() {
  displacement_.write(run_.data(), run_.size(), size_t{layout::kBrickSlots} * run_begin_);
  run_.clear();
}

StateView StateMirror::view() const {
  StateView view;
  view.displacement = displacement_.id();
  view.nodes = nodes_.id();
  view.bricks = brick_buffer_.id();
  view.bodies = bodies_.id();
  view.rest = rest_.id();
  view.spring_cut = spring_cut_.id();
  view.cut_revision = cut_revision_;
  view.stale_bricks = stale_buffer_.id();
  view.revision = revision_;
  view.moved_revision = moved_revision_;
  return view;
}

}  // namespace viscera
