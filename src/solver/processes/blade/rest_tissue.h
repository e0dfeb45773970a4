// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "solver/processes/blade/rest_fill.h"
#include "solver/processes/blade/rest_toughness.h"
#include "solver/processes/rest_grid.h"
#include "viscera/model/model.h"

namespace viscera {

class Archive;

/// A body at rest, as seen by a blade that it resists (docs/cutting.md): nodes by grid position, the share of tissue at
/// a position, and where it has been cut. The grid is that of a lattice; of other structures one with the mean spring
/// length as its spacing.
class RestTissue {
 public:
  /// Index where there is no node.
  static constexpr uint32_t kNone = 0xffffffffu;
  struct Node {
    uint32_t slot;  ///< slot in the solver's buffers
    float mass_kg;
    float inverse_mass;  ///< 1/kg, 0 if it is fixed
    float share;      ///< mass over that of a whole cell, or over the mean: nodes at the surface represent less tissue
    Vector3d rest_m;  ///< rest position, tissue frame
  };

  RestTissue(const Model& model, size_t body);

  const std::vector<Node>& nodes() const { return nodes_; }
  /// Calls visit(index into nodes()) for all nodes within a radius.
  template <class Visit>
  void forEachNear(const Vector3d& at_m, double radius_m, const Visit& visit) const;
  /// Returns the share of tissue in a cube of half a spacing around a position, 0 to 1. A sheet's thickness is spread
  /// to both sides.
  double fill(const Vector3d& at_m) const { return fill_.at(at_m); }
  /// Returns whether there is tissue, at a position where cuts are recorded.
  bool isTissue(const Vector3d& at_m) const { return fill(at_m) > 0 && halfAt(halfCell(at_m)) < parted_.size(); }
  bool isSheet() const { return fill_.isSheet(); }
  const RestToughness& toughness() const { return toughness_; }
  /// Records that a quadrilateral p q r s of tissue at rest has been cut.
  void part(const Vector3d& p, const Vector3d& q, const Vector3d& r, const Vector3d& s);
  /// Returns whether tissue has been cut in the cube of half a spacing around a position.
  bool isParted(const Vector3d& at_m) const;
  void reset();
  void persist(Archive& archive);

 private:
  void addNode(const Model& model, size_t body, uint32_t slot, double mass_kg, double whole_kg);
  void sortIntoGrid();
  Vector3i halfCell(const Vector3d& at_m) const;
  size_t halfAt(const Vector3i& half) const;

  RestGrid grid_;
  RestFill fill_;
  RestToughness toughness_;
  std::vector<Node> nodes_;
  std::vector<uint32_t> starts_, sorted_;  ///< nodes with that nearest position of the grid
  std::vector<uint8_t> parted_;            ///< 1 where cut, [8 * positions] by cubes of half a spacing
};

template <class Visit>
void RestTissue::forEachNear(const Vector3d& at_m, double radius_m, const Visit& visit) const {
  if (!at_m.allFinite()) return;
  const Vector3d most = grid_.count.cast<double>() - Vector3d::Ones();
  const auto clamped = [&](double reach_m) {
    const Vector3d at = (at_m + Vector3d::Constant(reach_m) - grid_.origin_m) / grid_.spacing_m;
    return Vector3i((at.cwiseMax(0).cwiseMin(most).array() + 0.5).floor().cast<int>());
  };
  const Vector3i low = clamped(-radius_m), high = clamped(radius_m);
  for (int z = low.z(); z <= high.z(); ++z) {
    for (int y = low.y(); y <= high.y(); ++y) {
      const size_t row = grid_.at({0, y, z});
      for (uint32_t i = starts_[row + static_cast<size_t>(low.x())];
           i < starts_[row + static_cast<size_t>(high.x()) + 1]; ++i) {
        if ((nodes_[sorted_[i]].rest_m - at_m).squaredNorm() < radius_m * radius_m) visit(sorted_[i]);
      }
    }
  }
}

}  // namespace viscera
