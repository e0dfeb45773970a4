// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/steps/leapfrog_pass.h"

namespace viscera {

LeapfrogPass::LeapfrogPass(const FeatureSet& features, AwakeBricks* awake)
    : awake_(awake), group_size_(features.group_size) {
  std::vector<std::string> defines = features.defines();
  if (awake) defines.push_back("AWAKE");
  plain_ = gpu::Program::compute("leapfrog.comp", defines);
  if (features.law) cells_.emplace(features, awake);
  if (!features.tools) return;
  defines.push_back("TOOLS");
  with_tools_ = gpu::Program::compute("leapfrog.comp", defines);
  edges_.emplace(features);
}

void LeapfrogPass::run(LatticeBuffers& buffers, const Substep& step) {
  if (awake_) awake_->list();
  if (cells_) cells_->run(buffers);
  const gpu::Program& program = step.tools ? with_tools_ : plain_;
  program.use();
  setSubstep(program, buffers, step);
  if (step.tools) {
    program.set("edge_reach", step.edge_reach_m);
    edges_->bind();
  }
  if (awake_)
    awake_->dispatchNodes();
  else
    gpu::Program::dispatch(buffers.store.active_count, group_size_);
  gpu::Program::storageBarrier();
  if (step.tools) edges_->run(buffers, step);
  if (awake_) awake_->passed(step);
}

}  // namespace viscera
