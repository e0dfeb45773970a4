// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/forces/reaction_pass.h"

#include "layout/bindings.h"
#include "solver/gpu/buffers/sum_tree.h"

namespace viscera {

ReactionPass::ReactionPass(const FeatureSet& features, size_t active_count, bool obstacles)
    : partials_(sumTreeSize(active_count), "sums of reactions"), group_size_(features.group_size) {
  std::vector<std::string> defines = features.defines();
  if (obstacles) defines.push_back("OBSTACLES");
  fold_ = gpu::Program::compute("sum_impulses.comp", defines);
  defines.push_back("LEAVES");
  leaves_ = gpu::Program::compute("sum_impulses.comp", defines);
}

void ReactionPass::runObstacles(const LatticeBuffers& buffers, const std::vector<Vector3f>& positions) const {
  for (size_t first = 0; first < positions.size(); first += layout::kMaxStyluses) {
    const bool both = first + 1 < positions.size();
    sum(buffers, {positions[first], both ? positions[first + 1] : Vector3f::Zero().eval()},
        static_cast<uint32_t>(first));
  }
}

/// Sums the impulses of two givers at a time.
/// @param giver  the first of the two
void ReactionPass::sum(const LatticeBuffers& buffers, const Positions& tips, uint32_t giver) const {
  partials_.bindStorage(layout::kBindPartials);
  size_t inputs = buffers.store.active_count, input_first = 0, output_first = 0;
  for (bool first = true; first || inputs > 1; first = false) {
    const size_t outputs = sumRuns(inputs);
    const gpu::Program& program = first ? leaves_ : fold_;
    program.use();
    program.set("input_count", static_cast<uint32_t>(inputs));
    program.set("input_first", static_cast<uint32_t>(input_first));
    program.set("output_first", static_cast<uint32_t>(output_first));
    program.set("last_level", outputs == 1 ? 1u : 0u);
    program.set("first_giver", giver);
    if (first) {
      program.set("slot_count", static_cast<uint32_t>(buffers.store.slot_count));
      program.setVectors("tips", tips[0].data(), 3, tips.size());
    }
    gpu::Program::dispatch(outputs, group_size_);
    gpu::Program::storageBarrier();
    input_first = output_first;
    output_first += outputs;
    inputs = outputs;
  }
}

}  // namespace viscera
