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

/// The nodes around an edge, as stored in the solver's buffers: in runs of eight consecutive slots, the first a
/// multiple of eight, for vector instructions.
struct BladeNodes {
  static constexpr size_t kLanes = kRunSlots;

  /// Gathers all nodes within a radius of the centres. @param along  direction of the edge
  void gather(const RestTissue& tissue, const std::vector<Vector3d>& centres_m, const Vector3d& along, double radius_m);
  /// Converts momenta to changes of velocities.
  void toVelocities(RunPlanes& momenta) const;

  std::vector<uint32_t> runs;  ///< first slots, ascending
  // [8 * runs]; entries of slots without a nearby node, and their changes, are not used
  std::vector<float> share, inverse_mass;  ///< 0 for these
  RunPlanes rest_m, u, v;                  ///< rest positions, displacements, velocities
  std::vector<float> low_m, high_m;        ///< [runs] extent along the edge
  Vector3d origin_m = Vector3d::Zero();    ///< origin of rest_m, low_m, high_m
  Vector3d along = Vector3d::Zero();

 private:
  std::vector<uint32_t> found_;
  std::vector<uint8_t> is_found_;
};

/// Weights by which nodes share the impulse of a sample of a blade's edge, and by which their motion is averaged: nodes
/// within a radius, by (1 - r^2 / R^2)^2 and the amount of tissue of each.
struct BladeKernel {
  void make(const BladeNodes& nodes, const Vector3d& centre_m, double radius_m);
  /// Returns the means of displacements and velocities.
  void means(const BladeNodes& nodes, Vector3d& u_m, Vector3d& v_m_per_s) const;
  /// Writes weights over masses for mobility(). @param out  [nodes]
  void spread(const BladeNodes& nodes, std::vector<float>& out) const;
  /// Returns the change of this sample's velocity per impulse of another [1/kg]. @param other  result of its spread()
  double mobility(const std::vector<float>& other) const;
  /// Adds the momenta that nodes receive from an impulse.
  void give(const Vector3f& impulse, RunPlanes& momenta) const;
  /// Returns the inverse of F; in folded tissue the identity.
  Eigen::Matrix3d toRest(const BladeNodes& nodes);

  std::vector<uint32_t> runs;        ///< indices of the nodes' runs that have weights
  std::vector<float> weights;        ///< [8 * runs] weights of a mean
  Vector3d lean = Vector3d::Zero();  ///< vector from its centre to the mean position of its tissue [m]
  bool is_new = false;               ///< toRest() was not called yet

 private:
  Vector3f centre_m_ = Vector3f::Zero();  ///< relative to the nodes' origin
  Vector3f slope_sum_ = Vector3f::Zero();
  float per_radius2_ = 0, sum_ = 0;
};

}  // namespace viscera
