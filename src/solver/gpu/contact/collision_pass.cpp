// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/contact/collision_pass.h"

#include <algorithm>
#include <cstddef>

#include "gpu/archive.h"
#include "gpu/gl.h"
#include "layout/bindings.h"
#include "solver/contact/environment.h"
#include "solver/contact/node_pairs.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

CollisionPass::CollisionPass(const Model& model, const Scene& scene, const FeatureSet& features,
                             const LatticeBuffers& buffers, bool ahead)
    : config_(scene.collision),
      widened_(ahead                   ? kPairReach
               : solvesContacts(scene) ? kMissedReach
                                       : 1.0f),
      cell_m_(static_cast<float>(std::max(1.0f, widened_) * collisionCell(model, config_))),
      touch_depths_(touchDepths(model, scene.collision)),
      contacts_(buffers.store.slot_count, "contacts"),
      corrections_(2 * buffers.store.slot_count, "corrections"),
      group_size_(features.group_size) {
  const auto stage = [&features, ahead](const char* name) {
    std::vector<std::string> defines = features.defines();
    if (ahead) defines.insert(defines.end(), {"AHEAD", "INCREMENT"});
    return gpu::Program::compute(name, defines);
  };
  const size_t nodes = buffers.store.active_count;
  count_ = stage("collision_count.comp");
  position_ = stage("collision_place.comp");
  scatter_ = stage("collision_scatter.comp");
  order_ = stage("collision_order.comp");
  bucket_count_ = bucketCount(nodes);
  buckets_ = gpu::Buffer<uint32_t>(3 * size_t{bucket_count_} + 2, "buckets");
  unsorted_ = gpu::Buffer<uint32_t>(nodes, "unsorted");
  entries_ = gpu::Buffer<layout::uvec4>(nodes, "entries");
  before_ = gpu::Buffer<layout::vec4>(nodes, "before");
  meet_ = stage("collision_meet.comp");
  if (ahead) {
    record_ = stage("collision_record.comp");
  } else {
    push_ = stage("collision_push.comp");
    pairs_ = stage("collision_pairs.comp");
  }
  bind();  // reports buffers that are too large for the driver at once
}

void CollisionPass::bind() const {
  touch_depths_.bindStorage(layout::kBindTouchDepths);
  contacts_.bindStorage(layout::kBindContacts);
  corrections_.bindStorage(layout::kBindCorrections);
  buckets_.bindStorage(layout::kBindBuckets);
  unsorted_.bindStorage(layout::kBindUnsorted);
  entries_.bindStorage(layout::kBindEntries);
  before_.bindStorage(layout::kBindEntriesBefore);
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
  program.set("most_in_bucket", kMostInBucket);
  program.set("friction", static_cast<float>(config_.friction));
  program.set("restitution", static_cast<float>(config_.restitution));
}

void CollisionPass::dispatch(size_t count) const {
  gpu::Program::dispatch(count, group_size_);
  gpu::Program::storageBarrier();
}

void CollisionPass::search(const LatticeBuffers& buffers, const Substep& step) const {
  buckets_.clear();
  for (const gpu::Program* stage : {&count_, &position_, &scatter_, &order_}) {
    tell(*stage, buffers, step);
    dispatch(stage == &position_ ? bucket_count_ : buffers.store.active_count);
  }
}

void CollisionPass::record(const LatticeBuffers& buffers, const Substep& step, const Tell& also) const {
  bind();
  search(buffers, step);
  for (const gpu::Program* stage : {&meet_, &record_}) {
    tell(*stage, buffers, step);
    also(*stage);
    dispatch(buffers.store.active_count);
  }
}

void CollisionPass::run(const LatticeBuffers& buffers, const Substep& step) const {
  bind();
  search(buffers, step);
  for (const gpu::Program* stage : {&meet_, &push_}) {
    tell(*stage, buffers, step);
    dispatch(buffers.store.active_count);
  }
}

void CollisionPass::recordCrowded(const gpu::Buffer<layout::TickStats>& stats) const {
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
  search(buffers, {});
  tell(pairs_, buffers, {});
  pairs_.set("most_pairs", static_cast<uint32_t>(most));
  dispatch(buffers.store.active_count);
  const std::vector<uint32_t> words = found.read();
  std::vector<CollisionPair> out(std::min<size_t>(words[0], most));
  for (size_t i = 0; i < out.size(); ++i) out[i] = {words[1 + 2 * i], words[2 + 2 * i]};
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace viscera
