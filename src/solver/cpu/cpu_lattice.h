// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "math/aligned.h"
#include "solver/edge_forces.h"
#include "solver/features.h"
#include "solver/joined_network.h"
#include "viscera/math/types.h"
#include "viscera/model/model.h"
#include "viscera/solver/material.h"
#include "viscera/solver/state.h"

namespace viscera {

/// The lattices of all bodies and their state in host memory: what every part of the CPU backend works on. Slots are
/// those of the GPU backend (viscera/layout/); vectors are stored brick by brick, one component after the other, so
/// that a plane of 4x4 nodes is 16 floats on end:
///   component c of slot s is at (s / 64) * 192 + c * 64 + s % 64     (vectorAt)
struct CpuLattice {
  /// @param bodies  [bodies] material constants   @param features  what has arrays beyond the state itself
  /// @throws SceneError  parts (strengths)
  CpuLattice(const Model& model, const std::vector<layout::BodyParams>& bodies, const FeatureSet& features);

  /// Rest state, whole springs, nothing held.
  void reset();
  /// What was output becomes the current state.
  void swap() { current = 1 - current; }
  HostState read() const;
  void write(const HostState& state);
  /// Fits what is derived from a node's bits (stiffness of its even springs, mobility) to bits that have changed.
  void refresh(uint32_t slot);

  layout::uint connections(uint32_t slot) const { return bodies[nodes[slot].hi >> layout::kBodyShift].connections; }
  size_t slotCount() const { return nodes.size(); }
  size_t brickCount() const { return bricks.size(); }

  std::vector<layout::Brick> bricks;       ///< [bricks] neighbours numbered over all bodies
  std::vector<layout::BodyParams> bodies;  ///< [bodies]
  std::vector<layout::NodeBits> nodes;     ///< [slots] as on the GPU, body index included
  std::vector<uint32_t> active;            ///< [active] slots, ascending
  std::vector<uint32_t> first_active;      ///< [bricks + 1] where a brick's nodes begin in active
  std::vector<uint32_t> cells;             ///< [cells] slots of the lowest corners of filled cells, ascending
  AlignedVector<float> displacement[2];    ///< [3 * slots] m (vectorAt)
  AlignedVector<float> velocity[2];        ///< [3 * slots] m/s
  AlignedVector<float> stiffness;          ///< [9 * slots] N/m of even springs (stiffnessAt); 0 cut or absent
  AlignedVector<float> mass;               ///< [slots] kg; 1 where no node is
  AlignedVector<float> mobility;     ///< [slots] 1/kg of nodes that take part in a substep, held ones too; 0: absent,
                                     ///< fixed, alone
  AlignedVector<float> bulk;         ///< [slots] J of the cell above the node; 0 torn or absent; empty without volumes
  AlignedVector<float> both_ends;    ///< [18 * slots] N/m of all springs, from either end, spring s of slot i at
                                     ///< (i / 64) * 1152 + s * 64 + i % 64
  AlignedVector<float> bulk_around;  ///< [8 * slots] J of the cells in which a slot is corner c (bits x, y, z), at
                                     ///< (slot / 64) * 512 + c * 64 + slot % 64; empty without volumes
  std::vector<uint8_t> uniform;     ///< [bricks] all springs of all its nodes are whole and of the body's full strength
  std::vector<uint16_t> idle_rows;  ///< [bricks] bit r: none of the four nodes from 4 r on will ever move
  std::vector<layout::vec4> grab_offsets;  ///< [slots] m, stylus frame; empty without styluses
  std::vector<layout::vec4> impulses;  ///< [kMaxStyluses * slots] N s, w substeps of contact; empty without styluses
  std::vector<uint8_t> touched;        ///< [bricks] some of its impulses are not 0; empty without styluses
  std::vector<uint8_t> held;           ///< [bricks] nodes of it are held; empty without styluses
  JoinedNetwork network;          ///< explicit connections, without stiffness where they are cut; masses are in mass
  EdgeForces edge_forces;         ///< empty unless edge by edge
  std::vector<float> spring_cut;  ///< [springs] as in HostState
  int current = 0;

 private:
  float springStiffness(uint32_t slot, uint32_t pair) const;
  float cellBulk(uint32_t slot) const;
  bool isFull(uint32_t slot) const;
  void refreshAll();
  void noteIdleRows();
  void shareBulk(uint32_t slot);

  void writeSpringCut(const std::vector<float>& cut);

  std::vector<layout::NodeBits> whole_nodes_;
  std::vector<layout::Link> whole_links_;
  Strengths strengths_;  ///< of models with parts, whose counts only say alive or cut; else empty
};

/// Index of component 0 of a slot in displacement and velocity; components are 64 apart.
constexpr size_t vectorAt(uint32_t slot) {
  return size_t{slot >> 6} * 192 + (slot & 63);
}

/// The vector of a slot in displacement or velocity.
inline Vector3f planesAt(const float* planes, uint32_t slot) {
  const float* at = planes + vectorAt(slot);
  return {at[0], at[64], at[128]};
}
inline void setPlanes(float* planes, uint32_t slot, const Vector3f& value) {
  float* at = planes + vectorAt(slot);
  at[0] = value.x();
  at[64] = value.y();
  at[128] = value.z();
}

/// Index of spring 2 * pair of a slot in stiffness.
constexpr size_t stiffnessAt(uint32_t slot, uint32_t pair) {
  return size_t{slot >> 6} * 576 + size_t{pair} * 64 + (slot & 63);
}

}  // namespace viscera
