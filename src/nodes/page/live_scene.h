// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "export/page/page_shapes.h"
#include "export/page/surface_coder.h"
#include "nodes/page/live_markers.h"
#include "nodes/page/live_message.h"
#include "nodes/received/sent_surface.h"

namespace viscera::nodes {

/// Converts the topics of a simulator to messages for browsers.
class LiveScene {
 public:
  /// @param newton_m  length of the arrows in scene_markers [m/N]
  explicit LiveScene(double newton_m) : newton_m_(newton_m) {}

  LiveMarkers& markers() { return markers_; }
  /// Returns the present moment; null if it looks like the last one, or if there is no surface.
  std::shared_ptr<const LiveFrame> next(const received::SentSurface& surface, const PoseOfFrame& pose_of);
  /// Makes the next moment differ from the last one, for a new browser.
  void repeat() { is_new_ = true; }
  void clear();

 private:
  void takeSurface(const received::SentSurface& surface);
  void beginBase(const received::SentSurface& surface);
  void putTubes(PageBytes& out, nlohmann::ordered_json& styles) const;
  void putForces(PageBytes& out) const;
  bool hasMoved(const std::vector<LiveMarkers::Placed>& placed) const;

  const double newton_m_;
  LiveMarkers markers_;
  // The surface, and the base that it refers to.
  VisibleMesh mesh_;
  SurfaceVerticesConstPtr shown_;
  std::shared_ptr<const received::SentTopology> topology_;
  SurfaceCoder coder_;
  SceneColors colors_;
  std::vector<uint32_t> plain_;  ///< colours of the base, without those of vertices
  std::shared_ptr<const LivePart> base_;
  // The last moment.
  std::vector<LiveMarkers::Placed> placed_;
  uint32_t frames_ = 0;
  bool is_new_ = true;
};

}  // namespace viscera::nodes
