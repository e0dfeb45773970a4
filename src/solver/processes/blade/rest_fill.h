// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "solver/processes/rest_grid.h"
#include "viscera/model/model.h"

namespace viscera {

/// Share of tissue at a rest position, 0 to 1, smooth. The effective length of an edge is its length times the mean of
/// this along it.
class RestFill {
 public:
  RestFill(const Body& body, const RestGrid& nodes);
  double at(const Vector3d& at_m) const;
  bool isSheet() const { return shares_.empty(); }

 private:
  void addCells(const Lattice& lattice);
  void addSheet(const SpringNetwork& network, double density_kg_per_m3);
  double ofCells(const Vector3d& at_m) const;
  double ofSheet(const Vector3d& at_m) const;
  double awayFrom(size_t triangle, const Vector3d& at_m) const;

  RestGrid cells_;             ///< a node of it is the lowest corner of a cell
  double side_;                ///< side of the cube over which the border of the cells is smoothed
  std::vector<float> shares_;  ///< [cells] share of tissue
  double thickness_m_ = 0;     ///< thickness of a sheet
  double reach_m_ = 0;         ///< distance to both sides of a sheet over which its thickness is spread
  std::vector<std::array<Vector3d, 3>> triangles_;
  std::vector<std::array<uint8_t, 3>> borders_;  ///< 1: the side from corner i to the next belongs to one triangle only
  std::vector<uint32_t> starts_, listed_;        ///< triangles within reach of each cube around a node of the grid
};

}  // namespace viscera
