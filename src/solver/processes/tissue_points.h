// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "solver/processes/port.h"
#include "solver/processes/rest_elements.h"
#include "viscera/math/types.h"
#include "viscera/model/model.h"

namespace viscera {

/// Points of tissue in a substep that was just made (TissuePort): where they are, and what impulses do to them. Reads
/// the nodes of all of them once, and writes once.
class TissuePoints {
 public:
  /// @param model  must outlive it
  explicit TissuePoints(const Model& model);
  /// Springs that are cut, for what is embedded from now on.
  void setCuts(CutSprings cuts) { cuts_ = std::move(cuts); }
  /// Carried by the cell around a place at rest; where that is cut, by the nearest whole cell on the place's side.
  /// @returns nothing where there is no tissue
  std::optional<TissuePoint> embed(uint32_t body, const Vector3d& rest_m) const;
  /// Around a place as the tissue is now: in whichever body and cell. Slow beside embed(), for what begins to touch: it
  /// reads up to 256 nodes of each body, and then goes through the tissue from the nearest of them with up to 24 reads
  /// of a cell's nodes each. In the gap of a wound there is nothing.
  std::optional<TissuePoint> find(TissuePort& target, const Vector3d& place_m) const;

  Vector3d rest_m(uint32_t slot) const { return rest_m_[slot].cast<double>(); }  ///< of a node, in the tissue frame
  double spacing_m(uint32_t body) const { return elements_[body].spacing_m(); }

  /// Begins a substep. @param points  all that will be asked for
  void read(TissuePort& target, const std::vector<const TissuePoint*>& points);
  Vector3d place_m(
      const TissuePoint& point) const;  ///< at the end of the substep, impulses given since read() among it
  Vector3d velocity_m_per_s(const TissuePoint& point) const;
  /// What an impulse at one changes another's velocity by [1/kg].
  double mobility(const TissuePoint& one, const TissuePoint& other) const;
  void give(const TissuePoint& point, const Vector3d& impulse_ns, double dt_s);
  /// Of any point; reads its nodes.
  Vector3d placeIn(const TissuePort& target, const TissuePoint& point) const;
  /// A way in the tissue as it is now, at rest: by the inverse of the deformation; where it is folded, as it is.
  Vector3d toRest(const TissuePoint& point, const Vector3d& way_m) const;
  /// All of them go on, or back, at the speeds that they have.
  void drift(double by_s);
  double work_j() const { return work_j_; }  ///< that impulses have done since read()
  /// Ends a substep: writes what was given. @param stylus  whose reaction it is; kMaxStyluses: no one's
  void write(TissuePort& target, uint32_t stylus, double dt_s);

 private:
  struct Node {
    Vector3d x_m, v_m_per_s, dv_m_per_s;
  };
  std::optional<TissuePoint> walk(TissuePort& target, uint32_t body, Vector3d rest_m, const Vector3d& place_m) const;
  Eigen::Matrix3d gradient(const TissuePoint& point, const std::vector<Vector3d>& nodes) const;
  std::vector<Vector3d> places_m(const TissuePort& target, const std::vector<uint32_t>& slots) const;

  const Model& model_;
  CutSprings cuts_;
  std::vector<RestElements> elements_;         ///< [bodies]
  std::vector<std::vector<uint32_t>> sparse_;  ///< [bodies] a few of its nodes, from which find() begins
  std::vector<float> inverse_mass_;            ///< [slots] 1/kg; 0 where fixed, or none
  std::vector<Vector3f> rest_m_;               ///< [slots]
  // of the substep
  std::vector<uint32_t> slots_, wanted_;  ///< that are read, ascending; and by the points in their order
  std::vector<uint32_t> node_of_;         ///< [slots] index into nodes_, of those in slots_
  std::vector<Node> nodes_;
  std::vector<Vector3f> u_, v_;
  double work_j_ = 0;
};

}  // namespace viscera
