// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "math/aligned.h"
#include "solver/cpu/simd/kernels.h"
#include "solver/cpu/store/cpu_store.h"
#include "solver/tissue/joined_lattice.h"
#include "viscera/model/body/elasticity.h"

namespace viscera {

/// Cells in thin walls, in groups as the SIMD kernels take them (simd::WallGroups), and their forces node by node.
/// Nothing that they hold goes from one substep to the next.
///
/// Of an edge along an axis between the nodes a and b the sum of the second differences at both ends is
/// w_a (u_a' - 2 u_a + u_b) + w_b (u_a - 2 u_b + u_b'), a' and b' the nodes beyond. Both weights are 1 where the
/// springs to a' and to b' are alive. A row that ends at b has at b what it has at a: w_a = 2, w_b = 0.
class CpuWalls {
 public:
  CpuWalls() = default;
  /// @param table  of bodies with parts; rigidity_j as long as there are slots
  CpuWalls(const CpuStore& store, const JoinedMoments& moments, const Strengths& table);

  bool empty() const { return cells_.empty(); }
  bool has(uint32_t slot) const { return !empty() && position_[slot] != kNone; }
  /// Fits a cell to its springs. @param rigidity_j, bulk_j  what it has left
  void refresh(const CpuStore& store, uint32_t cell, float rigidity_j, float bulk_j);

  simd::WallGroups groups();
  const uint8_t* inWall() const { return in_wall_.data(); }  ///< [bricks] nodes of it are nodes of such cells
  /// Returns the groups with a cell that acts on one of some bricks, ascending.
  std::vector<uint32_t> acting(const std::vector<uint32_t>& bricks) const;
  /// Returns the bricks that groups look at, ascending.
  std::vector<uint32_t> seen(const std::vector<uint32_t>& groups) const;
  /// Takes over where the nodes of a brick are, `ahead_s` later. @param displacement, velocity  [3 * slots] m, m/s;
  /// velocity is not looked at where ahead_s is 0
  void place(uint32_t brick, const layout::BodyParams& body, const float* displacement, const float* velocity,
             float ahead_s);
  /// Writes what cells do to the nodes of a brick. @param out  [3 * slots] N
  void sumForces(uint32_t brick, float* out) const;
  /// Energy of the cells above a brick's nodes [J], and how much stiffer the stiffest is than at rest.
  std::array<float, 2> measured(uint32_t brick) const;

 private:
  void listNodes(const CpuStore& store);
  void addNumbers(const JoinedMoments& moments, const Strengths& table);
  void addForces();

  static constexpr uint32_t kNone = ~0u;

  std::vector<uint32_t> cells_;     ///< [kWallLanes * groups] slots; kNone where there is none
  std::vector<uint32_t> position_;  ///< [slots] place in cells_
  std::vector<uint32_t> bodies_;
  std::vector<uint32_t> nodes_;       ///< [groups][kWallNodes][kWallLanes] four times an index into slots_
  std::vector<uint32_t> slots_;       ///< [nodes] of cells in walls, ascending
  std::vector<uint32_t> first_node_;  ///< [bricks + 1] where a brick's begin
  AlignedVector<float> places_;       ///< [nodes][4]
  AlignedVector<float> ends_, moments_, numbers_, strengths_, laminate_numbers_, forces_, measured_;
  std::vector<const float*> laminates_;
  std::vector<float> rows_;                       ///< [kWallLanes * groups] of WallCell
  std::vector<uint8_t> in_wall_;                  ///< [bricks]
  std::vector<uint32_t> shares_;                  ///< places in forces_, node by node
  std::vector<uint32_t> first_share_;             ///< [nodes + 1] where a node's begin
  std::vector<std::vector<uint32_t>> bricks_of_;  ///< [groups] bricks of its nodes
  std::vector<std::vector<uint32_t>> cells_of_;   ///< [bricks] places in cells_
};

}  // namespace viscera
