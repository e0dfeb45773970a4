// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "viscera/math/types.h"

namespace viscera {

/// The skin of what is on the table, as it is shown: what a person steers by who sees a tool and feels nothing.
struct OrganSkin {
  std::vector<float> points_m;      ///< 3 per vertex
  std::vector<uint32_t> triangles;  ///< 3 vertices each, counter-clockwise from outside

  bool empty() const { return points_m.empty(); }
  Eigen::AlignedBox3d box() const;  ///< of all vertices [m]
};

/// How far a point is from the skin [m]; below 0 it is under it.
/// @returns nothing where there are no triangles, or these name vertices that there are not
std::optional<double> distanceToSkin(const OrganSkin& skin, const Vector3d& point_m);

constexpr double kStartGap_m = 0.015;  ///< from a tool that waits to the skin: more than the largest tip's radius

/// Where a tool waits that is to be used on this organ: on the line from its middle towards `side`, beyond all skin
/// that a tool on this line could meet, its shaft along the line and its tip towards the middle.
/// @param side  from the middle, need not be of length 1
Pose startBefore(const OrganSkin& skin, const Vector3d& side);

/// `side` of the hand's tools, for who looks as config/viscera.rviz does: before the organ, above it and on the left of
/// the picture, or on its right.
Vector3d sideOfHand(bool left);

}  // namespace viscera
