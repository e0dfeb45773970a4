// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <vector>

#include "solver/contact/rest_tissue.h"

namespace viscera {

/// The nodes around an edge, ordered along it, in arrays for vector instructions; as many as make whole vectors.
struct BladeNodes {
  static constexpr size_t kLanes = 8;
  using Planes = std::array<std::vector<float>, 3>;

  /// All within a radius of centres. @param along  the edge
  void gather(const RestTissue& tissue, const std::vector<Vector3d>& centres_m, const Vector3d& along, double radius_m);
  /// @param u_m, v_m_per_s  by slots
  void take(const std::vector<Vector3f>& u_m, const std::vector<Vector3f>& v_m_per_s);

  std::vector<uint32_t> slots;  ///< none for what only fills up
  std::vector<float> share, inverse_mass;
  std::vector<float> places_m;  ///< along the edge, ascending
  Planes rest_m, u, v;
  Vector3d origin_m = Vector3d::Zero();  ///< of rest_m and places_m
  Vector3d along = Vector3d::Zero();

 private:
  std::vector<uint32_t> found_;
  std::vector<uint8_t> is_found_;
};

/// How nodes share what a sample of a blade's edge gives, and say where its tissue is: those within a radius, by
/// (1 - r^2 / R^2)^2 and the tissue that each stands for.
struct BladeKernel {
  void make(const BladeNodes& nodes, const Vector3d& centre_m, double radius_m);
  /// Of displacements and velocities.
  void means(const BladeNodes& nodes, Vector3d& u_m, Vector3d& v_m_per_s) const;
  /// What an impulse of this one's changes another's velocity by [1/kg].
  double mobility(const BladeNodes& nodes, const BladeKernel& other) const;
  /// Adds the momenta that nodes get of an impulse.
  void give(const Vector3f& impulse, BladeNodes::Planes& momenta) const;
  /// The inverse of F; where tissue is folded, as if it were rigid.
  Eigen::Matrix3d toRest(const BladeNodes& nodes);

  size_t first = 0;                  ///< of the nodes
  std::vector<float> weights;        ///< of a mean, of nodes from the first one on
  Vector3d lean = Vector3d::Zero();  ///< from its middle to the mean of its tissue [m]
  bool is_new = false;               ///< since the last toRest()

 private:
  Vector3f centre_m_ = Vector3f::Zero();  ///< from the nodes' origin
  Vector3f slope_sum_ = Vector3f::Zero();
  float per_radius2_ = 0, sum_ = 0;
};

}  // namespace viscera
