// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/solver/gpu/grab_pass.h"

#include "gpu/gl.h"

namespace viscera {

GrabPass::GrabPass(const FeatureSet& features) : group_size_(features.group_size) {
  std::vector<std::string> defines = features.defines();
  take_ = gpu::Program::compute("grab.comp", defines);
  defines.push_back("RELEASE");
  release_ = gpu::Program::compute("grab.comp", defines);
}

void GrabPass::takeHold(const LatticeBuffers& buffers, uint32_t stylus, const Pose& pose, double radius_m) const {
  take_.use();
  const Vector3f tip = pose.position_m.cast<float>();
  const Eigen::Vector4f q = pose.orientation.coeffs().cast<float>();  // xyzw
  glUniform1ui(0, static_cast<GLuint>(buffers.active_count));
  glUniform1ui(1, stylus);
  glUniform4f(2, tip.x(), tip.y(), tip.z(), static_cast<float>(radius_m));
  glUniform4fv(3, 1, q.data());
  gpu::Program::dispatch(buffers.active_count, group_size_);
  gpu::Program::storageBarrier();
}

void GrabPass::letGo(const LatticeBuffers& buffers, uint32_t stylus, double release_speed_m_per_s) const {
  release_.use();
  glUniform1ui(0, static_cast<GLuint>(buffers.active_count));
  glUniform1ui(1, stylus);
  glUniform1f(4, static_cast<float>(release_speed_m_per_s));
  gpu::Program::dispatch(buffers.active_count, group_size_);
  gpu::Program::storageBarrier();
}

}  // namespace viscera
