// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "session/skin_visibility.h"

#include <algorithm>

#include "gpu/fence.h"
#include "gpu/gl.h"

namespace viscera {

std::vector<SkinBox> boxesOf(const SkinBoxes& boxes, const StateView& state, size_t slots) {
  std::vector<layout::vec4> read_m(slots);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  gpu::awaitGpu("where the skin is");
  glGetNamedBufferSubData(state.displacement, 0, static_cast<GLsizeiptr>(slots * sizeof(read_m[0])), read_m.data());
  return boxes.place(HostDisplacements::ofSlots(read_m));
}

SkinVisibility::SkinVisibility(const CameraConfig& camera, const SkinBoxes& boxes)
    : camera_(camera),
      pose_(opticalPose(camera)),
      frustum_(camera),
      rest_(boxes.atRest()),
      draw_hidden_(camera.draw_hidden) {
  updateRest();
}

void SkinVisibility::updateRest() {
  hides_at_rest_ = std::any_of(rest_.begin(), rest_.end(),
                               [&](const SkinBox& box) { return !box.isEmpty() && frustum_.misses(box); });
}

void SkinVisibility::place(const Pose& pose) {
  if (pose.position_m == pose_.position_m && pose.orientation.coeffs() == pose_.orientation.coeffs()) return;
  pose_ = pose;
  frustum_ = Frustum(camera_, pose);
  updateRest();
}

void SkinVisibility::update(const Surface& surface, const std::vector<SkinBox>* boxes) {
  seen_.assign(rest_.size(), 1);
  for (size_t b = 0; boxes && b < seen_.size(); ++b) seen_[b] = !frustum_.misses((*boxes)[b]);
  drawn_ = surface.runsOf(seen_);
}

void SkinVisibility::addTo(std::vector<uint8_t>& bodies) const {
  for (size_t b = 0; b < bodies.size(); ++b) bodies[b] |= seen_[b];
}

}  // namespace viscera
