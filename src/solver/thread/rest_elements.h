// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "solver/contact/rest_grid.h"
#include "viscera/model/model.h"
#include "viscera/solver/state.h"

namespace viscera {

/// A point of tissue that thread or needle holds: the nodes that carry it, with weights whose sum is 1.
struct TissuePoint {
  static constexpr size_t kMost = 8;
  uint32_t body = 0;
  uint32_t count = 0;                   ///< of nodes
  std::array<uint32_t, kMost> slots{};  ///< in the solver's buffers
  std::array<float, kMost> weights{};   ///< of a place; may be below 0 beside a cut, where they extrapolate
  Vector3d rest_m = Vector3d::Zero();   ///< tissue frame
};

/// A node. @param slot  of its body
TissuePoint nodePoint(const Model& model, uint32_t body, uint32_t slot);

/// What carries places of a body: cells of its lattice, or triangles of a sheet, by where they are at rest.
class RestElements {
 public:
  /// @param slot_offset, first_spring  of the body in the solver's buffers, and of its network among all of them
  RestElements(const Model& model, uint32_t body, uint32_t first_spring);

  /// By the element around a place at rest; where springs of that are cut, by the nearest whole one on the place's
  /// side of the cut. @returns nothing where there is no tissue
  std::optional<TissuePoint> embed(const Vector3d& rest_m, const CutSprings& cuts) const;
  /// As embed(), and outside of tissue by the nearest element. @returns nothing where there is none within some
  /// spacings
  std::optional<TissuePoint> nearest(const Vector3d& rest_m, const CutSprings& cuts) const;

  double spacing_m() const { return cubes_.spacing_m; }
  /// What weights change with the place: columns [nodes] for x, y, z [1/m].
  Eigen::Matrix<double, Eigen::Dynamic, 3> slopes(const TissuePoint& point) const;
  /// Of a sheet: its normal at rest; else zero.
  Vector3d normal(const TissuePoint& point) const;

 private:
  using Corners = std::array<uint32_t, TissuePoint::kMost>;  ///< slots in the body
  using Weights = std::array<double, TissuePoint::kMost>;
  using Sides = std::array<uint32_t, TissuePoint::kMost>;  ///< of corners: the lowest that whole springs lead to
  struct Fit {
    uint32_t element = 0;
    Weights weights{};
    double outside_m = 0, off_m = 0;  ///< beyond the element's borders, and beside a sheet
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
  std::vector<uint32_t> starts_, sorted_;                 ///< elements that reach into a cube
};

}  // namespace viscera
