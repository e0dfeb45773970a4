// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "solver/contact/rest_grid.h"
#include "viscera/model/model.h"

namespace viscera {

/// How much of a place at rest is tissue, 0 to 1, smoothly: an edge has the length of its mean along it.
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
  double side_;                ///< of cells: of the cube within which tissue begins smoothly
  std::vector<float> shares_;  ///< [cells] that are tissue
  double thickness_m_ = 0;     ///< of a sheet
  double reach_m_ = 0;         ///< to both sides of a sheet, within which its thickness is spread
  std::vector<std::array<Vector3d, 3>> triangles_;
  std::vector<std::array<uint8_t, 3>> borders_;  ///< is the side from corner i to the next one of one triangle only?
  std::vector<uint32_t> starts_, listed_;        ///< triangles within reach of each cube around a node of the grid
};

}  // namespace viscera
