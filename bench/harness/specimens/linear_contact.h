// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "viscera/model/scene/body_config.h"

namespace viscera::bench {

/// What lies around and below a block that is pressed from above.
enum class Surroundings {
  kHalfSpace,  ///< more of the same, without end: the far faces move as under point loads on it (Boussinesq)
  kBonded      ///< nothing at the sides, a rigid plate that holds the bottom
};

/// A rigid sphere without friction on the flat top of a lattice, for infinitesimal displacements, in float64: which
/// nodes it touches, and with what force. By symmetry a quarter of the block is enough: n^3 cells for one of
/// 2n x 2n x n, the sphere above the middle of its top.
class LinearContact {
 public:
  /// @param reach_m  no node farther than this from the axis is ever touched
  LinearContact(int cells, double spacing_m, const MaterialConfig& material, Surroundings surroundings, double reach_m);

  struct Result {
    double force_n = 0;  ///< of all four quarters
    int touched = 0;     ///< nodes of all four quarters
  };
  /// @param depth_m  of the sphere's lowest point below the flat surface
  Result press(double radius_m, double depth_m) const;

 private:
  struct Candidate {
    double distance_m;  ///< from the axis
    int images;         ///< nodes that mirror it, itself included: 1, 2 or 4
  };
  std::vector<Candidate> candidates_;
  Eigen::MatrixXd compliance_;  ///< [m/N] how far candidate i sinks if j and its images are pressed by 1 N each
};

/// 4/3 E* sqrt(R) d^(3/2), E* = E / (1 - nu^2) [N].
double hertzForce(const MaterialConfig& material, double radius_m, double depth_m);

}  // namespace viscera::bench
