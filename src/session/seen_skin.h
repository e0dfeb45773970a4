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

/// Boxes of the skins in a state that is on the GPU alone: waits for it. @throws GpuError  it does not come
std::vector<SkinBox> boxesOf(const SkinBoxes& boxes, const StateView& state, size_t slots);

/// Which bodies one camera sees, so that no others are mapped and drawn for it (docs/hidden.md).
class SeenSkin {
 public:
  SeenSkin(const CameraConfig& camera, const SkinBoxes& boxes);

  /// Where the camera is from now on. @param pose  of its optical frame, tissue frame
  void place(const Pose& pose);
  /// Must it be known where the skins are before look()? Where that takes waiting for the GPU, only for a camera that
  /// does not see all bodies at rest.
  bool asks(bool on_host) const { return !draw_hidden_ && (on_host || hides_at_rest_); }
  /// @param boxes  [bodies] null: unknown, and all are seen
  void look(const Surface& surface, const std::vector<SkinBox>* boxes);
  /// Adds what was seen. @param bodies  [bodies]
  void addTo(std::vector<uint8_t>& bodies) const;
  const IndexRuns* drawn() const { return &drawn_; }

 private:
  void lookAtRest();

  const CameraConfig camera_;
  Pose pose_;  ///< of the optical frame, tissue frame
  Frustum frustum_;
  std::vector<SkinBox> rest_;  ///< [bodies] where they are at rest; empty without triangles
  std::vector<uint8_t> seen_;  ///< [bodies]
  bool draw_hidden_, hides_at_rest_ = false;
  IndexRuns drawn_;
};

}  // namespace viscera
