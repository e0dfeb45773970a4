// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/good_states.h"

#include <algorithm>

#include "gpu/archive.h"
#include "gpu/limits.h"
#include "layout/bindings.h"

namespace viscera {

GoodStates::GoodStates(size_t slots, int depth) {
  for (int i = 0; i < depth; ++i) {
    ring_.push_back(
        {gpu::Buffer<layout::vec4>(slots, "kept displacement"), gpu::Buffer<layout::vec4>(slots, "kept velocity")});
  }
  if (!gpu::driverLimits().loads) return;
  saves_ = gpu::Program::compute("save_state.comp", {"GROUP_SIZE " + std::to_string(layout::kGroupSize)});
}

void GoodStates::save(const LatticeBuffers& buffers, bool same) {
  same_ = same ? std::min(same_ + 1, static_cast<int>(ring_.size()) + 1) : 0;
  if (same_ <= static_cast<int>(ring_.size())) {
    keep(buffers, ring_[static_cast<size_t>(next_)]);
  }
  next_ = (next_ + 1) % static_cast<int>(ring_.size());
  kept_ = std::min(kept_ + 1, static_cast<int>(ring_.size()));
}

void GoodStates::keep(const LatticeBuffers& buffers, State& state) const {
  const gpu::Buffer<layout::vec4>& displacement = buffers.state.displacement[buffers.state.current];
  const gpu::Buffer<layout::vec4>& velocity = buffers.state.velocity[buffers.state.current];
  if (!saves_) {
    state.displacement.copyFrom(displacement);
    state.velocity.copyFrom(velocity);
    return;
  }
  gpu::bindStorages(layout::kBindSavedDisplacement, {state.displacement.id(), state.velocity.id()});
  saves_->use();
  saves_->set("slot_count", static_cast<uint32_t>(displacement.size()));
  gpu::Program::dispatch(displacement.size(), layout::kGroupSize);
  gpu::Program::storageBarrier();
}

void GoodStates::restore(LatticeBuffers& buffers, int back) {
  same_ = 0;
  const bool exhausted = back >= kept_;
  back = std::min(back, kept_ - 1);
  const int depth = static_cast<int>(ring_.size());
  next_ = (next_ - back + depth) % depth;
  kept_ -= back;
  buffers.state.displacement[buffers.state.current].copyFrom(last().displacement);
  buffers.state.velocity[buffers.state.current].copyFrom(last().velocity);
  if (exhausted) buffers.state.velocity[buffers.state.current].clear();
}

void GoodStates::persist(Archive& archive) {
  for (State& state : ring_) {
    gpu::persist(archive, state.displacement);
    gpu::persist(archive, state.velocity);
  }
  const auto states = static_cast<int>(ring_.size());
  int next = next_, kept = kept_;
  archive.value(next);
  archive.value(kept);
  archive.require(next >= 0 && next < states && kept >= 0 && kept <= states,
                  "there is no state to roll back to at this index");
  next_ = next;
  kept_ = kept;
  same_ = 0;
}

void GoodStates::bindLast() const {
  gpu::bindStorages(layout::kBindSavedDisplacement, {last().displacement.id(), last().velocity.id()});
}

}  // namespace viscera
