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

/// A body at rest, as a blade meets it that the tissue resists (docs/cutting.md): nodes by the places of a grid, how
/// much of a place is tissue, and where it has been parted. The grid is that of a lattice; of other structures one as
/// wide as their springs are long.
class RestTissue {
 public:
  /// Where no node is.
  static constexpr uint32_t kNone = 0xffffffffu;
  struct Node {
    uint32_t slot;  ///< in the solver's buffers
    float mass_kg;
    float inverse_mass;  ///< 1/kg, 0 where it is fixed
    float share;         ///< of a whole cell's mass, or of the mean: nodes at the surface stand for less tissue
    Vector3d rest_m;     ///< tissue frame
  };

  RestTissue(const Model& model, size_t body);

  const std::vector<Node>& nodes() const { return nodes_; }
  /// visit(index into nodes()) of all within a radius.
  template <class Visit>
  void forEachNear(const Vector3d& at_m, double radius_m, const Visit& visit) const;
  /// How much of a cube of half a spacing around a place is tissue, 0 to 1; a sheet's thickness is spread to both
  /// sides.
  double fill(const Vector3d& at_m) const { return fill_.at(at_m); }
  /// Is any there, and would it be noted that it has been parted?
  bool isTissue(const Vector3d& at_m) const { return fill(at_m) > 0 && halfAt(halfCell(at_m)) < parted_.size(); }
  bool isSheet() const { return fill_.isSheet(); }
  const RestToughness& toughness() const { return toughness_; }
  /// Notes that a quadrilateral p q r s of tissue at rest has been parted.
  void part(const Vector3d& p, const Vector3d& q, const Vector3d& r, const Vector3d& s);
  /// Has tissue been parted in the cube of half a spacing in which a place lies?
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
  std::vector<uint32_t> starts_, sorted_;  ///< nodes whose nearest place of the grid is that
  std::vector<uint8_t> parted_;            ///< [8 * places] by cubes of half a spacing
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
