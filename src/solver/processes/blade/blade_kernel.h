// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <vector>

#include "solver/processes/blade/rest_tissue.h"
#include "solver/processes/port.h"

namespace viscera {

/// The nodes around an edge, as they lie in the solver's buffers: in runs of eight slots that follow each other, the
/// first a multiple of eight, for vector instructions.
struct BladeNodes {
  static constexpr size_t kLanes = kRunSlots;

  /// All within a radius of centres. @param along  the edge
  void gather(const RestTissue& tissue, const std::vector<Vector3d>& centres_m, const Vector3d& along, double radius_m);
  /// Momenta become changes of velocities.
  void toVelocities(RunPlanes& momenta) const;

  std::vector<uint32_t> runs;  ///< first slots, ascending
  // [8 * runs]; of slots that are no nodes nearby, and of what they move by nothing is used
  std::vector<float> share, inverse_mass;  ///< 0 of these
  RunPlanes rest_m, u, v;                  ///< of displacements and velocities
  std::vector<float> low_m, high_m;        ///< [runs] along the edge
  Vector3d origin_m = Vector3d::Zero();    ///< of rest_m, low_m, high_m
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
  /// Writes weights over masses where mobility() looks for them. @param out  [nodes]
  void spread(const BladeNodes& nodes, std::vector<float>& out) const;
  /// What an impulse of another's changes this one's velocity by [1/kg]. @param other  what its spread() wrote
  double mobility(const std::vector<float>& other) const;
  /// Adds the momenta that nodes get of an impulse.
  void give(const Vector3f& impulse, RunPlanes& momenta) const;
  /// The inverse of F; where tissue is folded, as if it were rigid.
  Eigen::Matrix3d toRest(const BladeNodes& nodes);

  std::vector<uint32_t> runs;        ///< of the nodes' that have weights
  std::vector<float> weights;        ///< [8 * runs] of a mean
  Vector3d lean = Vector3d::Zero();  ///< from its middle to the mean of its tissue [m]
  bool is_new = false;               ///< since the last toRest()

 private:
  Vector3f centre_m_ = Vector3f::Zero();  ///< from the nodes' origin
  Vector3f slope_sum_ = Vector3f::Zero();
  float per_radius2_ = 0, sum_ = 0;
};

}  // namespace viscera
