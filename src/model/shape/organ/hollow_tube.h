// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "viscera/model/scene/body_config.h"
#include "viscera/model/shape/solid.h"

namespace viscera {

/// Hollow round tube with branches (`source: tube`), in the body's frame: a wall around a lumen, along smooth axes.
/// Ends that lie in the lumen of another branch join it; all others are open and flat.
class HollowTube {
 public:
  /// Axis of the tube (index 0) or of a branch, as straight pieces.
  struct Axis {
    std::vector<Vector3d> points_m;
    std::vector<double> along_m;  ///< [points] length from the start
    double radius_m = 0, wall_m = 0;
    bool opens_at_start = true, opens_at_end = true;

    double length_m() const { return along_m.back(); }
    double lumenRadius_m() const { return radius_m - wall_m; }
  };
  /// Position relative to an axis.
  struct Place {
    uint32_t axis = 0;
    double along_m = 0;     ///< of the nearest point of the axis
    double aside_m = 0;     ///< distance from the axis, or beyond its ends from the line that extends it
    double beyond_m = 0;    ///< distance beyond the nearest open end along the axis; negative: before it
    double distance_m = 0;  ///< from the nearest point of the axis
  };

  /// @throws SceneError  a path, radius or wall that makes no tube; names the keys below `body`
  HollowTube(const TubeConfig& config, const std::string& body);

  const std::vector<Axis>& axes() const { return axes_; }
  std::vector<std::string> partNames() const { return names_; }
  double thinnestWall_m() const;
  double narrowestLumen_m() const;  ///< least radius of a lumen
  Eigen::AlignedBox3d bounds() const;

  Place placeOn(uint32_t axis, const Vector3d& point_m) const;
  /// Returns the place on the axis of the branch that a point belongs to.
  Place nearest(const Vector3d& point_m) const;
  /// Returns the distance to the tissue, and its branch.
  LabelledDistance tissue(const Vector3d& point_m) const;
  /// Returns the distance to the space within the tube, with flat caps at open ends.
  double lumen(const Vector3d& point_m) const;
  /// Returns whether a point of the border of that space is on a cap.
  bool isOnCap(const Vector3d& point_m) const;

 private:
  void add(const std::vector<MarkPoint>& path, double radius_m, double wall_m, const std::string& key);
  void join();
  bool isInLumenOf(uint32_t axis, const Vector3d& point_m) const;

  std::vector<Axis> axes_;
  std::vector<std::string> names_, keys_;
};

/// Moves the vertices of an extracted surface onto the border of a field, where its slope is defined.
/// @param reach_m  farthest that a vertex moves
void moveOntoBorder(const std::function<double(const Vector3d&)>& distance_m, double reach_m, TriangleMesh& mesh);
/// Moves vertices on a curved border outwards by as much as their triangles cut off, so that the mesh has the volume of
/// the field.
void compensateChords(const std::function<double(const Vector3d&)>& distance_m, TriangleMesh& mesh);

}  // namespace viscera
