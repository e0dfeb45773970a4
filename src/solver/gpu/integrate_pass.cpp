// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/solver/gpu/integrate_pass.h"

#include "gpu/gl.h"

namespace viscera {

std::vector<std::string> FeatureSet::defines() const {
  std::vector<std::string> out = {"GROUP_SIZE " + std::to_string(group_size), "TEXELS"};
  if (dashpot) out.push_back("DASHPOT");
  if (single_body) out.push_back("SINGLE_BODY");
  return out;
}

IntegratePass::IntegratePass(const FeatureSet& features) : group_size_(features.group_size) {
  std::vector<std::string> defines = features.defines();
  plain_ = gpu::Program::compute("integrate.comp", defines);
  defines.push_back("TOOLS");
  with_tools_ = gpu::Program::compute("integrate.comp", defines);
}

void IntegratePass::run(const LatticeBuffers& buffers, const Step& step) const {
  (step.tools ? with_tools_ : plain_).use();
  glUniform1ui(0, static_cast<GLuint>(buffers.active_count));
  glUniform1f(1, step.dt_s);
  glUniform1f(2, step.kick_s);
  glUniform3fv(3, 1, step.gravity.data());
  if (step.tools) glUniform1ui(4, static_cast<GLuint>(buffers.slot_count));
  gpu::Program::dispatch(buffers.active_count, group_size_);
  gpu::Program::storageBarrier();
}

}  // namespace viscera
