// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/reaction_pass.h"

#include "layout/bindings.h"
#include "solver/gpu/sum_tree.h"

namespace viscera {

ReactionPass::ReactionPass(const FeatureSet& features, size_t active_count)
    : partials_(sumTreeSize(active_count)), group_size_(features.group_size) {
  std::vector<std::string> defines = features.defines();
  fold_ = gpu::Program::compute("sum_impulses.comp", defines);
  defines.push_back("LEAVES");
  leaves_ = gpu::Program::compute("sum_impulses.comp", defines);
}

void ReactionPass::run(const LatticeBuffers& buffers, const std::array<Vector3f, layout::kMaxStyluses>& tips) const {
  partials_.bindStorage(layout::kBindPartials);
  size_t inputs = buffers.active_count, input_first = 0, output_first = 0;
  for (bool first = true; first || inputs > 1; first = false) {
    const size_t outputs = sumRuns(inputs);
    const gpu::Program& program = first ? leaves_ : fold_;
    program.use();
    program.set(0, static_cast<uint32_t>(inputs));
    program.set(1, static_cast<uint32_t>(input_first));
    program.set(2, static_cast<uint32_t>(output_first));
    program.set(3, outputs == 1 ? 1u : 0u);
    if (first) {
      program.set(4, static_cast<uint32_t>(buffers.slot_count));
      for (size_t s = 0; s < tips.size(); ++s) {
        program.set(5 + static_cast<int>(s), {tips[s].x(), tips[s].y(), tips[s].z()});
      }
    }
    gpu::Program::dispatch(outputs, group_size_);
    gpu::Program::storageBarrier();
    input_first = output_first;
    output_first += outputs;
    inputs = outputs;
  }
}

}  // namespace viscera
