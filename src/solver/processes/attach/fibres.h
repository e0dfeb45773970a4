// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "solver/processes/attach/cohesive_law.h"
#include "solver/processes/rest_elements.h"
#include "viscera/model/model.h"

namespace viscera {

struct Scene;

/// Fibre between two bodies. Both of its ends have the same position at rest, so its length at rest is zero, and its
/// force along the line between its ends has no moment.
struct Fibre {
  uint32_t attachment = 0;          ///< index into Scene::attachments
  std::array<TissuePoint, 2> ends;  ///< in the body of the finer spacing, and in the other
  std::array<Vector3d, 2> seats_m;  ///< positions at rest within the tissue of the two bodies, which choose the cells
  Vector3d rest_m = Vector3d::Zero();  ///< position of both ends at rest, tissue frame
  Vector3d normal = Vector3d::Zero();  ///< outward normal of the first body's surface at rest
  double area_m2 = 0;
  CohesiveLaw law;
};

/// Elements of the bodies that carry ends of fibres.
class FibreCells {
 public:
  /// @param model  must outlive it
  explicit FibreCells(const Model& model);

  /// Returns the point of a body at a rest position, carried by the cell around a seat. @returns nothing if the cell is
  /// cut and there is no whole one on the seat's side
  std::optional<TissuePoint> carry(uint32_t body, const Vector3d& seat_m, const Vector3d& rest_m,
                                   const CutSprings& cuts) const;
  /// Returns the nearest position within a cell of a body.
  std::optional<Vector3d> seatNear(uint32_t body, const Vector3d& at_m) const;
  /// Returns a position, moved onto the border of the cell around a seat if it is as good as on it: then four nodes
  /// carry it instead of eight.
  Vector3d onBorder(uint32_t body, const Vector3d& seat_m, const Vector3d& at_m) const;
  /// Returns the derivatives of the weights by position: columns for x, y, z [1/m].
  Eigen::Matrix<double, 8, 3> slopes(const TissuePoint& point) const;

 private:
  Vector3d inCell(const TissuePoint& point, const Vector3d& at_m) const;
  const Model& model_;
  std::vector<RestElements> elements_;  ///< [bodies]
};

/// Grows the fibres of all attachments of a scene.
/// @throws SceneError  nothing of the bodies is within reach, or the reach is too large for the spacing
std::vector<Fibre> growFibres(const Scene& scene, const Model& model, const FibreCells& cells);

/// Returns the bound of the squared frequency that the fibres of a scene add to the tissue's own [1/s2]; 0 without
/// attachments. @throws SceneError  as growFibres()
double attachmentRate(const Scene& scene, const Model& model);

}  // namespace viscera
