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

/// Points of tissue after a substep (TissuePort): their positions, and their response to impulses. Reads the nodes of
/// all points once, and writes once.
class TissuePoints {
 public:
  /// @param model  must outlive it
  explicit TissuePoints(const Model& model);
  /// Sets the cut springs, for following calls of embed().
  void setCuts(CutSprings cuts) { cuts_ = std::move(cuts); }
  /// Returns the point at a rest position, carried by the cell around it; if that is cut, by the nearest whole cell on
  /// the position's side.
  /// @returns nothing where there is no tissue
  std::optional<TissuePoint> embed(uint32_t body, const Vector3d& rest_m) const;
  /// Returns the point at a current position, in any body and cell. It is slow compared to embed() and meant for new
  /// contacts. It reads up to 256 nodes of each body, then walks through the tissue from the nearest of them, with up
  /// to 24 reads of a cell's nodes each. Returns nothing in the gap of a wound.
  std::optional<TissuePoint> find(TissuePort& target, const Vector3d& position_m) const;

  Vector3d rest_m(uint32_t slot) const { return rest_m_[slot].cast<double>(); }  ///< rest position, tissue frame
  double spacing_m(uint32_t body) const { return elements_[body].spacing_m(); }

  /// Begins a substep. @param points  all points that will be used in it
  void read(TissuePort& target, const std::vector<const TissuePoint*>& points);
  Vector3d position_m(
      const TissuePoint& point) const;  ///< position at the end of the substep, including impulses given since read()
  Vector3d velocity_m_per_s(const TissuePoint& point) const;
  /// Returns the change of another's velocity per impulse at one [1/kg].
  double mobility(const TissuePoint& one, const TissuePoint& other) const;
  void give(const TissuePoint& point, const Vector3d& impulse_ns, double dt_s);
  /// Returns the position of any point; reads its nodes.
  Vector3d positionIn(const TissuePort& target, const TissuePoint& point) const;
  /// Returns a vector in the current tissue mapped to rest, by the inverse of the deformation gradient; where tissue is
  /// folded, unchanged.
  Vector3d toRest(const TissuePoint& point, const Vector3d& offset_m) const;
  /// Moves all points on, or back, at their current velocities.
  void drift(double by_s);
  double work_j() const { return work_j_; }  ///< work of impulses since read()
  /// Ends a substep: writes the changes. @param stylus  receives the reaction; kMaxStyluses: none
  void write(TissuePort& target, uint32_t stylus, double dt_s);

 private:
  struct Node {
    Vector3d x_m, v_m_per_s, dv_m_per_s;
  };
  std::optional<TissuePoint> walk(TissuePort& target, uint32_t body, Vector3d rest_m, const Vector3d& position_m) const;
  Eigen::Matrix3d gradient(const TissuePoint& point, const std::vector<Vector3d>& nodes) const;
  std::vector<Vector3d> positions_m(const TissuePort& target, const std::vector<uint32_t>& slots) const;

  const Model& model_;
  CutSprings cuts_;
  std::vector<RestElements> elements_;         ///< [bodies]
  std::vector<std::vector<uint32_t>> sparse_;  ///< [bodies] a few of its nodes, from which find() starts
  std::vector<float> inverse_mass_;            ///< [slots] 1/kg; 0 for fixed and missing nodes
  std::vector<Vector3f> rest_m_;               ///< [slots]
  // data of the substep
  std::vector<uint32_t> slots_, wanted_;  ///< slots that are read, ascending; and those of the points in their order
  std::vector<uint32_t> node_of_;         ///< [slots] index into nodes_, valid for slots_
  std::vector<Node> nodes_;
  std::vector<Vector3f> u_, v_;
  double work_j_ = 0;
};

}  // namespace viscera
