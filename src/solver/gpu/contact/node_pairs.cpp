// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/contact/node_pairs.h"

#include "gpu/archive.h"
#include "layout/bindings.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

NodePairs::NodePairs(const Model& model, const Scene& scene, const FeatureSet& features, const LatticeBuffers& buffers)
    : search_(model, scene, features, buffers, true),
      config_(scene.collision),
      words_(1 + 2 * buffers.store.slot_count + mostPairEnds(buffers.store.active_count), "pairs"),
      rows_(2 * mostPairEnds(buffers.store.active_count), "contacts of pairs"),
      nodes_(3 * buffers.store.slot_count, "nodes with pairs") {
  bind();  // reports buffers that are too large for the driver at once
}

void NodePairs::bind() const {
  words_.bindStorage(layout::kBindPairWords);
  rows_.bindStorage(layout::kBindPairRows);
  nodes_.bindStorage(layout::kBindNodePairs);
}

void NodePairs::persist(Archive& archive) {
  gpu::persist(archive, nodes_);
  search_.persist(archive);
}

void NodePairs::find(const LatticeBuffers& buffers, const Substep& step) const {
  bind();
  words_.clear();
  search_.record(buffers, step, [&](const gpu::Program& program) { tell(program, step); });
}

void NodePairs::tell(const gpu::Program& program, const Substep& step) const {
  program.set("pair_slots", static_cast<uint32_t>(nodes_.size() / 3));
  program.set("most_pairs", static_cast<uint32_t>(rows_.size() / 2));
  program.set("pair_friction", static_cast<float>(config_.friction));
  program.set("pair_restitution", static_cast<float>(config_.restitution));
  program.set("pair_bounces_from", step.resting_speed_m_per_s);
}

}  // namespace viscera
