// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "solver/contact/tool_port.h"
#include "solver/cpu/kernels/near_blade.h"
#include "solver/cpu/state/cpu_lattice.h"
#include "viscera/layout/tick_stats.h"
#include "viscera/layout/tool_motion.h"

namespace viscera {

// Action of styluses on a CpuLattice (VR05 2.7, physics.md 5). The equations are the text of
// shaders/solver/tools/grab.comp, cut.comp, solver/tissue/cell_forces.comp and contact.glsl, compiled as C++.
// Everything runs on one thread unless stated otherwise.

/// Grips free nodes within a radius around the tip.
/// @param stylus  index, < kMaxStyluses
/// @param pose  of the stylus, tissue frame
/// @param radius_m  of the grip
void takeHold(CpuLattice& lattice, uint32_t stylus, const Pose& pose, double radius_m);

/// Releases the nodes that a stylus holds.
/// @param stats  of the tick, with the impulse of the stylus in it
void letGo(CpuLattice& lattice, uint32_t stylus, const Release& release, const layout::TickStats& stats);

/// Cutter that removes the springs that a swept blade crosses, at both ends, and marks cells that lose one. Allocates
/// nothing after the first cut.
class CpuCut {
 public:
  /// @param parallel  for the search of nodes near the blade; must outlive this
  CpuCut(CpuLattice& lattice, const Parallel& parallel, const simd::Kernels& kernels);
  /// Removes springs.
  /// @param particles  removes all springs of the nodes near the blade instead
  /// @param spared  [bodies] 1: keeps its springs; null: none does
  /// @param at_rest  no node is displaced
  /// @return number of springs cut
  uint32_t run(CpuLattice& lattice, const layout::ToolMotion& motion, bool particles, const uint8_t* spared = nullptr,
               bool at_rest = false);
  /// Marks the cells around nodes of the last run that have lost a spring, to it or to the later cut of network links.
  void tearCells(CpuLattice& lattice) const;
  /// Returns the bricks that the last run tested.
  const std::vector<uint32_t>& bricks() const { return near_.bricks(); }

 private:
  template <class Kernel>
  uint32_t cutWith(CpuLattice& lattice, const layout::ToolMotion& motion, const uint8_t* spared);
  template <class Springs, class Particles>
  uint32_t cutAll(CpuLattice& lattice, const layout::ToolMotion& motion, bool particles, const uint8_t* spared);

  NearBlade near_;
  std::vector<uint32_t> changed_;  ///< slots that lost springs
};

/// Applies all styluses to nodes that have just made a substep: probes push them out, grips hold them. May run
/// concurrently for nodes of different bricks.
/// @param motions  [kMaxStyluses] of the substep
/// @param slots  [count]; nodes that never move are skipped
void resolveContacts(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions, const uint32_t* slots,
                     size_t count);

/// Contacts of probes with springs on the surface, between their ends, after all nodes have made the substep
/// (shaders/solver/tools/edges.glsl). Runs on one thread.
class CpuEdges {
 public:
  /// @param slots  of the lattice; 0 if there are never tools
  explicit CpuEdges(size_t slots);
  ~CpuEdges();
  /// Adds the springs of some nodes that a probe may touch.
  /// @param slots  [count], each at most once in a substep
  void add(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions, const uint32_t* slots,
           size_t count);
  /// Pushes the springs of the added nodes, and clears the list.
  void run(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions);

 private:
  struct Lists;
  std::vector<uint32_t> slots_;
  std::unique_ptr<Lists> lists_;  ///< of a substep; the memory is reused
};

/// Sums the impulses of styluses in a tick into impulse, angular and touched, in fixed order and float64, and clears
/// them.
/// @param tips  of the styluses at the end of the tick, tissue frame [m]
void sumReactions(CpuLattice& lattice, const std::array<Vector3f, layout::kMaxStyluses>& tips,
                  layout::TickStats& stats);

/// Sums the impulses of obstacles in the same manner.
/// @param places  [obstacles] positions at the end of the tick, tissue frame [m]
void sumObstacles(CpuLattice& lattice, const std::vector<Vector3f>& positions, layout::TickStats& stats);

}  // namespace viscera
