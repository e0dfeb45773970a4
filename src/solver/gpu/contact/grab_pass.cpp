// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/contact/grab_pass.h"

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
  take_.set("active_count", static_cast<uint32_t>(buffers.store.active_count));
  take_.set("stylus", stylus);
  take_.set("tip", {tip.x(), tip.y(), tip.z(), static_cast<float>(radius_m)});
  take_.set("orientation", {q.x(), q.y(), q.z(), q.w()});
  gpu::Program::dispatch(buffers.store.active_count, group_size_);
  gpu::Program::storageBarrier();
}

void GrabPass::letGo(const LatticeBuffers& buffers, uint32_t stylus, const Release& release) const {
  release_.use();
  release_.set("active_count", static_cast<uint32_t>(buffers.store.active_count));
  release_.set("stylus", stylus);
  release_.set("release_speed", static_cast<float>(release.speed_m_per_s));
  release_.set("above", static_cast<float>(release.above_n_s));
  gpu::Program::dispatch(buffers.store.active_count, group_size_);
  gpu::Program::storageBarrier();
}

}  // namespace viscera
