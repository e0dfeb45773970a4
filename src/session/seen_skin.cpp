// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "session/seen_skin.h"

#include "gpu/fence.h"
#include "gpu/gl.h"

namespace viscera {

void SkinPlaces::follow(const SkinGroups& groups, const HostDisplacements& displacements) {
  groups.place(displacements, groups_);
  bodies_ = groups.bodyBoxes(groups_);
}

void SkinPlaces::follow(const SkinGroups& groups, const StateView& state, size_t slots) {
  read_m_.resize(slots);
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  gpu::awaitGpu("where the skin is");
  glGetNamedBufferSubData(state.displacement, 0, static_cast<GLsizeiptr>(slots * sizeof(read_m_[0])), read_m_.data());
  follow(groups, HostDisplacements::ofSlots(read_m_));
}

SeenSkin::SeenSkin(const CameraConfig& camera, const Model& model, const SkinGroups& groups)
    : camera_(camera),
      pose_(opticalPose(camera)),
      frustum_(camera),
      closed_(closedBodies(model)),
      draw_hidden_(camera.draw_hidden) {
  SkinPlaces rest;
  rest.follow(groups, HostDisplacements::ofSlots(std::vector<layout::vec4>(model.slots(), layout::vec4{0, 0, 0, 0})));
  rest_ = rest.groups();
  lookAtRest(groups);
}

void SeenSkin::lookAtRest(const SkinGroups& groups) {
  see(groups, rest_);
  hides_at_rest_ = !groups.areAll(shown_);
}

void SeenSkin::place(const Pose& pose, const SkinGroups& groups) {
  if (pose.position_m == pose_.position_m && pose.orientation.coeffs() == pose_.orientation.coeffs()) return;
  pose_ = pose;
  frustum_ = Frustum(camera_, pose);
  lookAtRest(groups);
}

void SeenSkin::see(const SkinGroups& groups, const std::vector<SkinBox>& boxes) {
  shown_.resize(groups.count());
  for (size_t g = 0; g < shown_.size(); ++g) shown_[g] = !frustum_.misses(boxes[g]);
}

void SeenSkin::look(const Surface& surface, const SkinPlaces* places) {
  const SkinGroups& groups = surface.groups();
  fronts_only_.assign(closed_.size(), 0);
  if (places) {
    see(groups, places->groups());
    for (size_t b = 0; b < closed_.size(); ++b)
      fronts_only_[b] = closed_[b] && !groups.isWounded(b) && frustum_.isBeside(places->bodies()[b]);
  } else {
    shown_.assign(groups.count(), 1);
  }
  drawn_.choose(surface, shown_, fronts_only_);
}

void SeenSkin::addTo(std::vector<uint8_t>& shown) const {
  for (size_t g = 0; g < shown.size(); ++g) shown[g] |= shown_[g];
}

}  // namespace viscera
