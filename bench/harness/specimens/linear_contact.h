// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "viscera/model/scene/body_config.h"

namespace viscera::bench {

/// Boundary conditions of a block that is pressed from above.
enum class FarField {
  kHalfSpace,  ///< the far faces move as under point loads on a half-space (Boussinesq)
  kBonded      ///< free sides and a rigid plate that fixes the bottom
};

/// Frictionless contact of a rigid sphere with the flat top of a lattice, for infinitesimal displacements in float64.
/// Computes the touched nodes and the force. By symmetry a quarter of the block suffices: n^3 cells represent 2n x 2n x
/// n cells, with the sphere above the centre of the top.
class LinearContact {
 public:
  /// @param reach_m  largest distance from the axis of a node that may be touched
  LinearContact(int cells, double spacing_m, const MaterialConfig& material, FarField far_field, double reach_m);

  struct Result {
    double force_n = 0;  ///< force of all four quarters [N]
    int touched = 0;     ///< number of nodes in all four quarters
  };
  /// Presses the sphere. @param depth_m  depth of the sphere's lowest point below the flat surface
  Result press(double radius_m, double depth_m) const;

 private:
  struct Candidate {
    double distance_m;  ///< distance from the axis [m]
    int images;         ///< number of mirror images of the node, including itself: 1, 2 or 4
  };
  std::vector<Candidate> candidates_;
  Eigen::MatrixXd compliance_;  ///< [m/N] displacement of candidate i if j and its images are each pressed by 1 N
};

/// Returns 4/3 E* sqrt(R) d^(3/2), E* = E / (1 - nu^2) [N].
double hertzForce(const MaterialConfig& material, double radius_m, double depth_m);

}  // namespace viscera::bench
