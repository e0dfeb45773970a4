// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "viscera/model/model.h"

namespace viscera {

class Archive;

/// A lattice at rest, as a blade meets it that the tissue resists (docs/cutting.md): nodes by their places in the grid,
/// how much of a place is tissue, and where it has been parted.
class RestTissue {
 public:
  /// Where no node is.
  static constexpr uint32_t kNone = 0xffffffffu;
  struct Node {
    uint32_t slot;  ///< in the solver's buffers
    float mass_kg;
    float inverse_mass;  ///< 1/kg, 0 where it is fixed
    float share;         ///< of a whole cell's mass: nodes at the surface stand for less tissue
    Vector3d rest_m;     ///< tissue frame
  };

  RestTissue(const Model& model, size_t body);

  double spacing_m() const { return spacing_m_; }
  const std::vector<Node>& nodes() const { return nodes_; }
  /// visit(index into nodes()) of all within a radius.
  template <class Visit>
  void forEachNear(const Vector3d& at_m, double radius_m, const Visit& visit) const;
  /// How much of a cube of half a spacing around a place is tissue, 0 to 1.
  double fill(const Vector3d& at_m) const;
  /// Notes that a quadrilateral p q r s of tissue at rest has been parted.
  void part(const Vector3d& p, const Vector3d& q, const Vector3d& r, const Vector3d& s);
  /// Has tissue been parted in the cube of half a spacing in which a place lies?
  bool isParted(const Vector3d& at_m) const;
  void reset();
  void persist(Archive& archive);

 private:
  size_t at(const Vector3i& node) const;
  Vector3i halfCell(const Vector3d& at_m) const;
  size_t halfAt(const Vector3i& half) const;

  double spacing_m_;
  Vector3d origin_m_;
  Vector3i count_;  ///< nodes per axis
  std::vector<Node> nodes_;
  std::vector<uint32_t> grid_;   ///< [count] index into nodes_, kNone where no node is
  std::vector<float> shares_;    ///< [count] of the cell whose lowest corner it is, that is tissue
  std::vector<uint8_t> parted_;  ///< [8 * count] by cubes of half a spacing
};

template <class Visit>
void RestTissue::forEachNear(const Vector3d& at_m, double radius_m, const Visit& visit) const {
  const Vector3d middle = (at_m - origin_m_) / spacing_m_;
  const double reach = radius_m / spacing_m_;
  if (!middle.allFinite()) return;
  Vector3i low, high;
  for (int a = 0; a < 3; ++a) {
    low[a] = static_cast<int>(std::ceil(std::max(0.0, middle[a] - reach)));
    high[a] = static_cast<int>(std::floor(std::min(count_[a] - 1.0, middle[a] + reach)));
  }
  for (int z = low.z(); z <= high.z(); ++z) {
    for (int y = low.y(); y <= high.y(); ++y) {
      for (int x = low.x(); x <= high.x(); ++x) {
        const uint32_t node = grid_[at({x, y, z})];
        if (node == kNone || (nodes_[node].rest_m - at_m).squaredNorm() >= radius_m * radius_m) continue;
        visit(node);
      }
    }
  }
}

inline size_t RestTissue::at(const Vector3i& node) const {
  const auto row = static_cast<size_t>(count_.x()), layer = row * static_cast<size_t>(count_.y());
  return static_cast<size_t>(node.x()) + row * static_cast<size_t>(node.y()) + layer * static_cast<size_t>(node.z());
}

}  // namespace viscera
