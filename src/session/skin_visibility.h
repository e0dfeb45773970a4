// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "render/frustum.h"
#include "surface/skin_boxes.h"
#include "surface/surface.h"
#include "viscera/solver/state.h"

namespace viscera {

/// Returns the boxes of the surface meshes for a state that is only on the GPU: waits for it. @throws GpuError  it does
/// not arrive
std::vector<SkinBox> boxesOf(const SkinBoxes& boxes, const StateView& state, size_t slots);

/// Visibility of bodies for one camera: only visible ones are mapped and drawn (docs/surface.md).
class SkinVisibility {
 public:
  SkinVisibility(const CameraConfig& camera, const SkinBoxes& boxes);

  /// Sets the pose of the camera. @param pose  of its optical frame, tissue frame
  void place(const Pose& pose);
  /// Returns whether look() needs the boxes of the surfaces. If that requires a wait for the GPU, only for a camera
  /// that does not see all bodies at rest.
  bool asks(bool on_host) const { return !draw_hidden_ && (on_host || hides_at_rest_); }
  /// Updates the visibility. @param boxes  [bodies] null: unknown, and all are visible
  void update(const Surface& surface, const std::vector<SkinBox>* boxes);
  /// Adds the visible bodies. @param bodies  [bodies]
  void addTo(std::vector<uint8_t>& bodies) const;
  const IndexRuns* drawn() const { return &drawn_; }

 private:
  void updateRest();

  const CameraConfig camera_;
  Pose pose_;  ///< pose of the optical frame, tissue frame
  Frustum frustum_;
  std::vector<SkinBox> rest_;  ///< [bodies] boxes at rest; empty without triangles
  std::vector<uint8_t> seen_;  ///< [bodies] whether the body is visible
  bool draw_hidden_, hides_at_rest_ = false;
  IndexRuns drawn_;
};

}  // namespace viscera
