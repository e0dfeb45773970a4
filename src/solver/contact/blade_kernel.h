// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <vector>

#include "solver/contact/rest_tissue.h"

namespace viscera {

/// The nodes that share what a sample of a blade's edge gives, and that say where its tissue is: those within a radius,
/// by (1 - r^2 / R^2)^2 and the tissue that each stands for.
struct BladeKernel {
  void make(const RestTissue& tissue, const Vector3d& centre_m, double radius_m);
  /// Of two quantities at once. @param a, b  by places
  void means(const std::vector<Vector3f>& a, const std::vector<Vector3f>& b, Vector3d& mean_a, Vector3d& mean_b) const;
  /// The inverse of F; where tissue is folded, as if it were rigid. @param u_m  displacements by places
  Eigen::Matrix3d toRest(const std::vector<Vector3f>& u_m);

  std::vector<uint32_t> nodes;       ///< of the tissue
  std::vector<uint32_t> places;      ///< of these nodes where those of all kernels are together
  std::vector<float> weights;        ///< of a mean
  std::vector<float> mobilities;     ///< weight over mass [1/kg], 0 of fixed nodes: what an impulse gives each
  std::vector<Vector3f> slopes;      ///< of the gradient of a mean [1/m]
  Vector3d lean = Vector3d::Zero();  ///< from its middle to the mean of its tissue [m]
  bool is_new = false;               ///< since the last toRest()
};

}  // namespace viscera
