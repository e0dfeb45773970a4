// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/contact/collision_pass.h"

#include <algorithm>
#include <cstddef>

#include "gpu/archive.h"
#include "gpu/gl.h"
#include "layout/bindings.h"
#include "solver/contact/node_pairs.h"
#include "solver/contact/surroundings.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

namespace {

CollisionConfig completeSearch(CollisionConfig config) {
  config.search = CollisionSearch::kGrid;
  return config;
}

}  // namespace

CollisionPass::CollisionPass(const Model& model, const Scene& scene, const FeatureSet& features,
                             const LatticeBuffers& buffers, bool ahead)
    : config_(ahead ? completeSearch(scene.collision) : scene.collision),
      widened_(ahead                   ? kPairReach
               : solvesContacts(scene) ? kMissedReach
                                       : 1.0f),
      cell_m_(static_cast<float>(std::max(1.0f, widened_) * collisionCell(model, config_))),
      touch_depths_(touchDepths(model, scene.collision)),
      contacts_(buffers.store.slot_count, "contacts"),
      corrections_(2 * buffers.store.slot_count, "corrections"),
      group_size_(features.group_size) {
  const auto stage = [&features, ahead, this](const char* name) {
    std::vector<std::string> defines = features.defines();
    if (config_.search == CollisionSearch::kStaggered) defines.push_back("STAGGERED");
    if (ahead) defines.insert(defines.end(), {"AHEAD", "INCREMENT"});
    return gpu::Program::compute(name, defines);
  };
  const size_t nodes = buffers.store.active_count;
  if (config_.search == CollisionSearch::kGrid) {
    count_ = stage("collision_count.comp");
    place_ = stage("collision_place.comp");
    scatter_ = stage("collision_scatter.comp");
    order_ = stage("collision_order.comp");
    bucket_count_ = bucketCount(nodes);
    buckets_ = gpu::Buffer<uint32_t>(3 * size_t{bucket_count_} + 2, "buckets");
    unsorted_ = gpu::Buffer<uint32_t>(nodes, "unsorted");
    entries_ = gpu::Buffer<layout::uvec4>(nodes, "entries");
    before_ = gpu::Buffer<layout::vec4>(nodes, "before");
  } else {
    list_ = stage("collision_list.comp");
    exchange_ = stage("collision_exchange.comp");
    rank_ = stage("collision_rank.comp");
    sorted_ = sortedCount(nodes);
    items_ = gpu::Buffer<std::array<uint32_t, 2>>(static_cast<size_t>(config_.partitions) * sorted_, "items");
    ranks_ = gpu::Buffer<uint32_t>(static_cast<size_t>(config_.partitions) * buffers.store.slot_count, "ranks");
  }
  meet_ = stage("collision_meet.comp");
  if (ahead) {
    note_ = stage("collision_note.comp");
  } else {
    push_ = stage("collision_push.comp");
    pairs_ = stage("collision_pairs.comp");
  }
  bind();  // what is too large for the driver is said now
}

void CollisionPass::bind() const {
  touch_depths_.bindStorage(layout::kBindTouchDepths);
  contacts_.bindStorage(layout::kBindContacts);
  corrections_.bindStorage(layout::kBindCorrections);
  if (config_.search == CollisionSearch::kGrid) {
    buckets_.bindStorage(layout::kBindBuckets);
    unsorted_.bindStorage(layout::kBindUnsorted);
    entries_.bindStorage(layout::kBindEntries);
    before_.bindStorage(layout::kBindEntriesBefore);
  } else {
    items_.bindStorage(layout::kBindSortItems);
    ranks_.bindStorage(layout::kBindRanks);
  }
}

void CollisionPass::persist(Archive& archive) {
  gpu::persist(archive, contacts_);
  gpu::persist(archive, corrections_);
}

void CollisionPass::restart() {
  contacts_.clear();
  corrections_.clear();
}

void CollisionPass::tell(const gpu::Program& program, const LatticeBuffers& buffers, const Substep& step) const {
  program.use();
  program.set("active_count", static_cast<uint32_t>(buffers.store.active_count));
  program.set("dt_s", step.dt_s);
  program.set("push_speed", step.push_speed_m_per_s);
  program.set("resting_speed", step.resting_speed_m_per_s);
  program.set("cell_m", cell_m_);
  program.set("widened", widened_);
  program.set("bucket_count", bucket_count_);
  if (config_.search == CollisionSearch::kGrid) program.set("most_in_bucket", kMostInBucket);
  program.set("friction", static_cast<float>(config_.friction));
  program.set("restitution", static_cast<float>(config_.restitution));
  program.set("partitions", static_cast<uint32_t>(config_.partitions));
  program.set("window", static_cast<uint32_t>(config_.window));
  program.set("sorted_count", sorted_);
  program.set("slot_count", static_cast<uint32_t>(buffers.store.slot_count));
}

void CollisionPass::dispatch(size_t count) const {
  gpu::Program::dispatch(count, group_size_);
  gpu::Program::storageBarrier();
}

void CollisionPass::searchGrid(const LatticeBuffers& buffers, const Substep& step) const {
  buckets_.clear();
  for (const gpu::Program* stage : {&count_, &place_, &scatter_, &order_}) {
    tell(*stage, buffers, step);
    dispatch(stage == &place_ ? bucket_count_ : buffers.store.active_count);
  }
}

/// Bitonic: runs of 2, 4, ... are sorted by comparing at half their length, a quarter, ... 1.
void CollisionPass::searchStaggered(const LatticeBuffers& buffers, const Substep& step) const {
  const size_t items = items_.size();
  tell(list_, buffers, step);
  dispatch(items);
  tell(exchange_, buffers, step);
  for (uint32_t run = 2; run <= sorted_; run *= 2) {
    for (uint32_t away = run / 2; away > 0; away /= 2) {
      exchange_.set("run", run);
      exchange_.set("away", away);
      dispatch(items / 2);
    }
  }
  tell(rank_, buffers, step);
  dispatch(items);
}

size_t CollisionPass::search(const LatticeBuffers& buffers, const Substep& step) const {
  if (config_.search == CollisionSearch::kGrid) {
    searchGrid(buffers, step);
    return buffers.store.active_count;
  }
  searchStaggered(buffers, step);
  return sorted_;
}

void CollisionPass::note(const LatticeBuffers& buffers, const Substep& step, const Tell& also) const {
  bind();
  const size_t entries = search(buffers, step);
  for (const gpu::Program* stage : {&meet_, &note_}) {
    tell(*stage, buffers, step);
    also(*stage);
    dispatch(entries);
  }
}

void CollisionPass::run(const LatticeBuffers& buffers, const Substep& step) const {
  bind();
  const size_t entries = search(buffers, step);
  for (const gpu::Program* stage : {&meet_, &push_}) {
    tell(*stage, buffers, step);
    dispatch(entries);
  }
}

void CollisionPass::noteCrowded(const gpu::Buffer<layout::TickStats>& stats) const {
  if (buckets_.size() == 0) return;
  glCopyNamedBufferSubData(buckets_.id(), stats.id(), static_cast<GLintptr>((buckets_.size() - 1) * sizeof(uint32_t)),
                           offsetof(layout::TickStats, crowded), sizeof(uint32_t));
}

std::vector<CollisionPair> CollisionPass::findPairs(const LatticeBuffers& buffers) const {
  constexpr size_t kPerNode = 64;
  const size_t most = kPerNode * buffers.store.active_count;
  const gpu::Buffer<uint32_t> found(1 + 2 * most);
  buffers.bind();
  bind();
  found.bindStorage(layout::kBindPairs);
  const size_t entries = search(buffers, {});
  tell(pairs_, buffers, {});
  pairs_.set("most_pairs", static_cast<uint32_t>(most));
  dispatch(entries);
  const std::vector<uint32_t> words = found.read();
  std::vector<CollisionPair> out(std::min<size_t>(words[0], most));
  for (size_t i = 0; i < out.size(); ++i) out[i] = {words[1 + 2 * i], words[2 + 2 * i]};
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace viscera
