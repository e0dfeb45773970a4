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

/// The skin around the places where a thread goes into tissue and comes out, on which its tails and loops lie: some
/// points of it, each a half space for what is nearest to it.
class ThreadSkin {
 public:
  static constexpr uint32_t kThing = 0xffff;  ///< ChainTouch::thing is this and more: by which of its places

  /// Around some places at rest, unless it is laid there already. @param outer  points of the outer channels
  void lay(const Model& model, const TissuePoints& points, const std::vector<const TissuePoint*>& outer);
  void forget() { laid_m_.clear(); }
  void addPoints(std::vector<const TissuePoint*>& points) const;

  /// Before a substep of the chain: where the skin is.
  void begin(const TissuePoints& points);
  /// The half space before a node, of those that are near. @param ahead_m  where it comes to
  std::optional<ChainTouch> near(const Vector3d& ahead_m, double reach_m, double dt_s) const;
  /// After it: the tissue is given what touches have.
  void give(const std::vector<ChainTouch>& touches, double dt_s, TissuePoints& points) const;

 private:
  struct Place {
    TissuePoint at, below;  ///< a little below the skin, and below that
    double depth_m;         ///< of `at`
  };
  struct Now {
    Vector3d place_m, normal, velocity_m_per_s;
    double mass_kg;
  };
  std::optional<size_t> nearest(const Vector3d& to_m, double within_m) const;

  std::vector<Vector3d> laid_m_;  ///< of outer channels at rest, around which it is laid
  std::vector<Place> places_;
  std::vector<Now> now_;
  std::vector<std::pair<double, size_t>> along_x_;  ///< x of these [m], which, ascending
  Eigen::AlignedBox3d box_m_;                       ///< around them
  double spacing_m_ = 0;
};

}  // namespace viscera
