// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "solver/processes/rest_grid.h"
#include "viscera/model/model.h"
#include "viscera/solver/state.h"

namespace viscera {

/// A point of tissue that holds a suture or needle: the nodes that carry it, with weights that sum to 1.
struct TissuePoint {
  static constexpr size_t kMost = 8;
  uint32_t body = 0;
  uint32_t count = 0;                   ///< number of nodes
  std::array<uint32_t, kMost> slots{};  ///< slots in the solver's buffers
  std::array<float, kMost> weights{};  ///< interpolation weights; may be negative next to a cut, where they extrapolate
  Vector3d rest_m = Vector3d::Zero();  ///< rest position, tissue frame
};

/// Returns the point at a node. @param slot  slot in its body
TissuePoint nodePoint(const Model& model, uint32_t body, uint32_t slot);

/// Elements that carry points of a body: cells of its lattice, or triangles of a sheet, found by their rest positions.
class RestElements {
 public:
  /// @param slot_offset, first_spring  indices of the body's first slot in the solver's buffers, and of its network's
  /// first spring among all
  RestElements(const Model& model, uint32_t body, uint32_t first_spring);

  /// Returns the point at a rest position, carried by the element around it. If springs of that are cut, by the nearest
  /// whole element on the position's side of the cut. @returns nothing where there is no tissue
  std::optional<TissuePoint> embed(const Vector3d& rest_m, const CutSprings& cuts) const;
  /// Returns the same as embed(), and outside tissue the point on the nearest element. @returns nothing if there is
  /// none within some spacings
  std::optional<TissuePoint> nearest(const Vector3d& rest_m, const CutSprings& cuts) const;

  double spacing_m() const { return cubes_.spacing_m; }
  /// Returns the derivatives of the weights by position: columns [nodes] for x, y, z [1/m].
  Eigen::Matrix<double, Eigen::Dynamic, 3> slopes(const TissuePoint& point) const;
  /// Returns the normal of a sheet at rest; else zero.
  Vector3d normal(const TissuePoint& point) const;

 private:
  using Corners = std::array<uint32_t, TissuePoint::kMost>;  ///< slots in the body
  using Weights = std::array<double, TissuePoint::kMost>;
  using Sides = std::array<uint32_t, TissuePoint::kMost>;  ///< lowest corner that whole springs connect to each one
  struct Fit {
    uint32_t element = 0;
    Weights weights{};
    double outside_m = 0, off_m = 0;  ///< distance beyond the element's borders, and from a sheet's plane
    bool isNearerThan(const Fit& other) const;
  };
  void collect();
  void sortIntoCubes();
  Vector3i cubeOf(const Vector3d& at_m) const;
  template <class Visit>
  void forEachAround(const Vector3d& at_m, int rings, const Visit& visit) const;
  template <class Takes>
  std::optional<Fit> nearestFit(const Vector3d& at_m, int rings, const Takes& takes) const;
  Fit fit(uint32_t element, const Vector3d& at_m) const;
  Weights weights(const Corners& corners, const Vector3d& at_m) const;
  TissuePoint pointOf(const Fit& fit, const Vector3d& rest_m) const;
  Vector3d corner_m(uint32_t element, uint32_t corner) const { return restPosition(body_, corners_[element][corner]); }
  bool isWhole(uint32_t element, const CutSprings& cuts) const;
  double cutAt(uint32_t a, uint32_t b, const CutSprings& cuts) const;
  Sides sidesOf(uint32_t element, const CutSprings& cuts) const;
  uint32_t sideOf(uint32_t element, const Sides& sides, const Vector3d& at_m, const CutSprings& cuts) const;

  const Body& body_;
  uint32_t number_, slot_offset_, first_spring_, count_;  ///< corners of an element
  std::vector<Corners> corners_;                          ///< [elements]
  RestGrid cubes_;                                        ///< a node of it is the lowest corner of a cube
  std::vector<uint32_t> starts_, sorted_;                 ///< elements that overlap a cube
};

}  // namespace viscera
