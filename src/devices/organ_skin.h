// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "viscera/math/types.h"

namespace viscera {

/// The rendered surface mesh of the organ, by which a user without force feedback places a tool.
struct OrganSkin {
  std::vector<float> points_m;      ///< 3 per vertex
  std::vector<uint32_t> triangles;  ///< 3 vertices each, counter-clockwise from outside

  bool empty() const { return points_m.empty(); }
  Eigen::AlignedBox3d box() const;  ///< bounding box of all vertices [m]
};

/// Returns the distance of a point from the surface [m]; below 0 it is inside.
/// @returns nothing if there are no triangles, or an index is out of range
std::optional<double> distanceToSkin(const OrganSkin& skin, const Vector3d& point_m);

constexpr double kStartGap_m = 0.015;  ///< distance of a waiting tool [m], above the largest tip radius

/// Returns the initial pose of a tool for this organ: on the line from the centre towards `side`, beyond all surface
/// that a tool on this line could touch. The shaft is along the line and the tip points to the centre.
/// @param side  direction from the centre, of any length
Pose startBefore(const OrganSkin& skin, const Vector3d& side);

/// Returns `side` for a left or right tool in the view of config/viscera.rviz: in front of the organ, above it, and on
/// the left or right of the image.
Vector3d sideOfTool(bool left);

}  // namespace viscera
