// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/math/types.h"

namespace viscera {

/// Round strand along a smooth curve, such as a vessel or a duct: a building block of phantoms (phantom_shapes.h).
class Strand {
 public:
  struct Knot {
    Vector3d at;
    double radius;
  };
  struct Nearest {
    double distance;  ///< to the surface, negative inside; of a strand far away only a lower bound
    double radius;    ///< of the strand there
  };

  Strand() = default;
  /// Makes a curve through the knots, with a radius that varies between them.
  /// @param knots  at least two
  /// @param far    distance beyond which that to the box around the strand is returned; at least the width of blends
  Strand(const std::vector<Knot>& knots, double far);

  Nearest nearest(const Vector3d& p) const;
  double distance(const Vector3d& p) const { return nearest(p).distance; }

 private:
  std::vector<Knot> points_;  ///< ends of straight pieces
  Eigen::AlignedBox3d box_;   ///< around the strand
  double far_ = 0;
};

/// Returns the ends of straight pieces of the smooth curve through knots (Catmull-Rom). @param knots  at least two
/// @param pieces  between two knots
std::vector<Strand::Knot> curveThrough(const std::vector<Strand::Knot>& knots, int pieces);

}  // namespace viscera
