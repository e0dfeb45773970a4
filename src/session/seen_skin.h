// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "render/drawn_skin.h"
#include "render/frustum.h"
#include "surface/skin_groups.h"
#include "viscera/solver/state.h"

namespace viscera {

/// Where the groups of a skin are in a state.
class SkinPlaces {
 public:
  void follow(const SkinGroups& groups, const HostDisplacements& displacements);
  /// Of a state that is on the GPU alone: waits for it. @throws GpuError  it does not come
  void follow(const SkinGroups& groups, const StateView& state, size_t slots);

  const std::vector<SkinBox>& groups() const { return groups_; }  ///< [groups]
  const std::vector<SkinBox>& bodies() const { return bodies_; }  ///< [bodies]

 private:
  std::vector<SkinBox> groups_, bodies_;
  std::vector<layout::vec4> read_m_;
};

/// What one camera sees of the skin, so that nothing else is mapped and drawn for it (docs/hidden.md).
class SeenSkin {
 public:
  SeenSkin(const CameraConfig& camera, const Model& model, const SkinGroups& groups);

  /// Where the camera is from now on. @param pose  of its optical frame, tissue frame
  void place(const Pose& pose, const SkinGroups& groups);
  /// Shall look() be told where the skin is? Where that is unknown without waiting for the GPU, only for a
  /// camera that does not see all of the skin at rest.
  bool asks(bool on_host) const { return !draw_hidden_ && (on_host || hides_at_rest_); }
  /// @param places  null: unknown, and all is seen
  void look(const Surface& surface, const SkinPlaces* places);
  /// Adds what was seen. @param shown  [groups]
  void addTo(std::vector<uint8_t>& shown) const;
  const DrawnSkin* drawn() const { return &drawn_; }

 private:
  void see(const SkinGroups& groups, const std::vector<SkinBox>& boxes);

  void lookAtRest(const SkinGroups& groups);

  const CameraConfig camera_;
  Pose pose_;  ///< of the optical frame, tissue frame
  Frustum frustum_;
  std::vector<SkinBox> rest_;                  ///< [groups] where they are at rest
  std::vector<uint8_t> closed_, fronts_only_;  ///< [bodies]
  std::vector<uint8_t> shown_;                 ///< [groups]
  bool draw_hidden_, hides_at_rest_ = false;
  DrawnSkin drawn_;
};

}  // namespace viscera
