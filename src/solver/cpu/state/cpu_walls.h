// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "math/aligned.h"
#include "solver/cpu/simd/kernels.h"
#include "solver/cpu/state/cpu_store.h"
#include "solver/tissue/joined_lattice.h"
#include "viscera/model/body/elasticity.h"

namespace viscera {

/// Cells in thin walls, in groups for the SIMD kernels (simd::WallGroups), and their forces node by node. They keep
/// nothing from one substep to the next.
///
/// For an edge along an axis between the nodes a and b, the sum of the second differences at both ends is w_a (u_a' - 2
/// u_a + u_b) + w_b (u_a - 2 u_b + u_b'), where a' and b' are the nodes beyond. Both weights are 1 if the springs to a'
/// and to b' are intact. If the row ends at b, the second difference at b equals that at a: w_a = 2, w_b = 0.
class CpuWalls {
 public:
  CpuWalls() = default;
  /// @param table  of bodies with parts: rigidity_j then has one entry per slot
  /// @param masses_kg  [slots]
  CpuWalls(const CpuStore& store, const JoinedMoments& moments, const Strengths& table,
           const AlignedVector<float>& masses_kg);

  bool empty() const { return cells_.empty(); }
  bool has(uint32_t slot) const { return !empty() && position_[slot] != kNone; }
  /// Updates a cell for its springs.
  /// @param rigidity_j, bulk_j  the remaining ones
  void refresh(const CpuStore& store, uint32_t cell, float rigidity_j, float bulk_j);

  simd::WallGroups groups();
  const uint8_t* inWall() const { return in_wall_.data(); }  ///< [bricks] 1: some of its nodes are nodes of such cells
  /// Returns the groups with a cell that acts on at least one of some bricks, ascending.
  std::vector<uint32_t> acting(const std::vector<uint32_t>& bricks) const;
  /// Returns the bricks with nodes of some groups, ascending.
  std::vector<uint32_t> seen(const std::vector<uint32_t>& groups) const;
  /// Copies the positions of the nodes of a brick, predicted by `ahead_s`.
  /// @param displacement, velocity  [3 * slots] m, m/s; velocity is not read if ahead_s is 0
  void place(uint32_t brick, const layout::BodyParams& body, const float* displacement, const float* velocity,
             float ahead_s);
  /// Writes the forces of cells on the nodes of a brick. Those on ghosts include the opposite of their weight.
  /// @param gravity  m/s2
  /// @param out  [3 * slots] N
  void sumForces(uint32_t brick, const Vector3f& gravity, float* out) const;
  /// Returns the energy of the cells above a brick's nodes [J], and the largest stiffness over that at rest.
  std::array<float, 2> measured(uint32_t brick) const;

 private:
  std::vector<uint32_t> listNodes(const CpuStore& store);
  void listGroups(const std::vector<uint32_t>& nodes);
  void addNumbers(const JoinedMoments& moments, const Strengths& table);
  void addForces();

  static constexpr uint32_t kNone = ~0u;

  std::vector<uint32_t> cells_;     ///< [kWallLanes * groups] slots; kNone if there is no cell
  std::vector<uint32_t> position_;  ///< [slots] index in cells_
  std::vector<uint32_t> bodies_;
  std::vector<uint32_t> first_listed_;  ///< [groups + 1] where a group's nodes begin in listed_
  std::vector<uint32_t> listed_;        ///< nodes of each group, ascending: four times an index in slots_
  std::vector<uint16_t> nodes_;         ///< [groups][kWallNodes][kWallLanes] four times an index among these
  std::vector<uint32_t> slots_;         ///< [nodes] slots of the nodes of cells in walls, ascending
  std::vector<uint32_t> first_node_;    ///< [bricks + 1] where a brick's nodes begin
  std::vector<float> ghosts_kg_;        ///< [nodes] masses of ghosts; 0 for nodes
  AlignedVector<float> positions_;      ///< [nodes][4]
  AlignedVector<float> ends_, moments_, numbers_, strengths_, laminate_numbers_, forces_, measured_;
  std::vector<const float*> laminates_;
  std::vector<float> rows_;                       ///< [kWallLanes * groups] WallCell::rows
  std::vector<uint8_t> in_wall_;                  ///< [bricks]
  std::vector<uint32_t> shares_;                  ///< indices in forces_, node by node
  std::vector<uint32_t> first_share_;             ///< [nodes + 1] where a node's indices begin
  std::vector<std::vector<uint32_t>> bricks_of_;  ///< [groups] bricks of its nodes
  std::vector<std::vector<uint32_t>> cells_of_;   ///< [bricks] indices in cells_
};

}  // namespace viscera
