// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <utility>
#include <vector>

#include "solver/processes/suture/chain/chain.h"
#include "solver/processes/tissue_points.h"
#include "viscera/model/model.h"

namespace viscera {

/// The surface around the points where a suture enters and leaves tissue, on which its tails and loops rest: some
/// points of it, each a half space for nearby nodes.
class SutureSkin {
 public:
  static constexpr uint32_t kThing = 0xffff;  ///< ChainTouch::thing is this plus the index of the place

  /// Places points around some rest positions, unless they are there already. @param outer  points of the outer
  /// channels
  void lay(const Model& model, const TissuePoints& points, const std::vector<const TissuePoint*>& outer);
  void clear() { laid_m_.clear(); }
  void addPoints(std::vector<const TissuePoint*>& points) const;

  /// Updates the surface before a substep of the chain.
  void begin(const TissuePoints& points);
  /// Returns the half space near a node, if any. @param ahead_m  predicted position of the node
  std::optional<ChainTouch> near(const Vector3d& ahead_m, double reach_m, double dt_s) const;
  /// Applies the impulses of touches to the tissue after the substep.
  void give(const std::vector<ChainTouch>& touches, double dt_s, TissuePoints& points) const;

 private:
  struct SurfacePoint {
    TissuePoint at, below;  ///< slightly below the surface, and below that
    double depth_m;         ///< depth of `at`
  };
  struct Now {
    Vector3d position_m, normal, velocity_m_per_s;
    double mass_kg;
  };
  std::optional<size_t> nearest(const Vector3d& to_m, double within_m) const;

  std::vector<Vector3d> laid_m_;  ///< outer channels at rest around which it is placed
  std::vector<SurfacePoint> positions_;
  std::vector<Now> now_;
  std::vector<std::pair<double, size_t>> along_x_;  ///< x of these [m] and index, ascending
  Eigen::AlignedBox3d box_m_;                       ///< around them
  double spacing_m_ = 0;
};

}  // namespace viscera
