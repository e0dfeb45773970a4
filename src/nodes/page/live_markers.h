// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <visualization_msgs/MarkerArray.h>

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "nodes/page/live_message.h"
#include "viscera/math/types.h"

namespace viscera::nodes {

/// Returns the pose of a frame in the tissue frame; nothing if it is not known.
using PoseOfFrame = std::function<std::optional<Pose>(const std::string& frame)>;

/// Polyline of a suture, a clip, a needle or a mark.
struct LiveTube {
  std::string part;  ///< name in the legend
  double radius_m = 0;
  std::array<uint8_t, 3> color{};
  std::vector<Vector3d> positions_m;  ///< tissue frame
};

/// What `scene_markers` shows besides tissue: tools and obstacles, lines, and arrows of forces. Held nodes and names
/// are left out.
class LiveMarkers {
 public:
  struct Placed {
    std::shared_ptr<const LivePart> part;
    Pose pose;  ///< tissue frame
  };
  struct Force {
    Vector3d tip_m = Vector3d::Zero(), arrow_m = Vector3d::Zero();  ///< tissue frame
  };

  /// Takes a message. Markers that are not finite or too large are left out. @returns whether something has changed
  bool take(const visualization_msgs::MarkerArray& message);
  void clear() { *this = LiveMarkers(next_part_); }
  /// Returns a number for a part that is not in use.
  uint32_t newPart() { return next_part_++; }

  /// Returns the meshes with a known frame.
  std::vector<Placed> placed(const PoseOfFrame& pose_of) const;
  std::vector<LiveTube> tubes() const;
  /// Returns the forces by stylus; zero without an arrow.
  std::vector<Force> forces() const;
  /// Returns the text while there is no tissue.
  const std::string& preparing() const { return preparing_; }

  LiveMarkers() = default;

 private:
  explicit LiveMarkers(uint32_t next_part) : next_part_(next_part) {}
  using Key = std::pair<std::string, int32_t>;  // namespace and id
  bool add(const visualization_msgs::Marker& marker);
  bool addMesh(const Key& key, const visualization_msgs::Marker& marker);

  struct Mesh {
    visualization_msgs::Marker marker;
    std::shared_ptr<const LivePart> part;
  };
  std::map<Key, Mesh> meshes_;
  std::map<Key, visualization_msgs::Marker> lines_;
  std::map<int32_t, Force> forces_;
  std::string preparing_;
  uint32_t next_part_ = 1;
};

}  // namespace viscera::nodes
