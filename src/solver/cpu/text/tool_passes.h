// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "solver/contact/tool_target.h"
#include "solver/cpu/store/cpu_lattice.h"
#include "solver/cpu/text/near_blade.h"
#include "viscera/layout/tick_stats.h"
#include "viscera/layout/tool_motion.h"

namespace viscera {

// What styluses do to a CpuLattice (VR05 2.7, physics.md 5). The equations are the text of
// shaders/solver/tools/grab.comp, cut.comp, solver/tissue/cell_forces.comp and contact.glsl, compiled as C++. On one
// thread, except where it says otherwise.

/// Takes hold of free nodes within a radius around the tip.
/// @param stylus  index, < kMaxStyluses   @param pose  of the stylus, tissue frame   @param radius_m  of the grip
void takeHold(CpuLattice& lattice, uint32_t stylus, const Pose& pose, double radius_m);

/// Lets go what a stylus holds. @param stats  of the tick, with what the stylus gave in it
void letGo(CpuLattice& lattice, uint32_t stylus, const Release& release, const layout::TickStats& stats);

/// Erases the springs that a swept blade crosses, from both ends, and with them cells that were whole. Allocates
/// nothing once it has cut.
class CpuCut {
 public:
  /// @param parallel  on which it looks for nodes near the blade; must outlive this
  CpuCut(CpuLattice& lattice, const Parallel& parallel, const simd::Kernels& kernels);
  /// @param particles  all springs of the nodes near the blade instead
  /// @param spared  [bodies] 1: it keeps its springs; null: none does
  /// @param at_rest  no node is displaced
  /// @return springs cut
  uint32_t run(CpuLattice& lattice, const layout::ToolMotion& motion, bool particles, const uint8_t* spared = nullptr,
               bool at_rest = false);
  /// Marks the cells around nodes of the last run that have lost a spring, to it or to the links of networks
  /// that were cut after it.
  void tearCells(CpuLattice& lattice) const;
  /// Looked at in the last run.
  const std::vector<uint32_t>& bricks() const { return near_.bricks(); }

 private:
  template <class Kernel>
  uint32_t cutWith(CpuLattice& lattice, const layout::ToolMotion& motion, const uint8_t* spared);
  template <class Springs, class Particles>
  uint32_t cutAll(CpuLattice& lattice, const layout::ToolMotion& motion, bool particles, const uint8_t* spared);

  NearBlade near_;
  std::vector<uint32_t> changed_;  ///< slots that lost springs
};

/// What all styluses do to nodes that have just made a substep: pushed out of probes, or where a stylus holds them. May
/// run for nodes of different bricks at the same time.
/// @param motions  [kMaxStyluses] of the substep   @param slots  [count] of which those that never move are left alone
void resolveContacts(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions, const uint32_t* slots,
                     size_t count);

/// What probes do to springs on the skin that they touch between their ends, once all nodes have made the substep
/// (shaders/solver/tools/edges.glsl). On one thread.
class CpuEdges {
 public:
  /// @param slots  of the lattice; 0 where no tool ever comes
  explicit CpuEdges(size_t slots);
  ~CpuEdges();
  /// Of these nodes those whose springs may be touched take part. @param slots  [count], each at most once in a substep
  void add(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions, const uint32_t* slots,
           size_t count);
  /// Pushes the springs of those added, and forgets them.
  void run(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions);

 private:
  struct Lists;
  std::vector<uint32_t> slots_;
  std::unique_ptr<Lists> lists_;  ///< of a substep: their memory is reused
};

/// Sums what styluses gave to nodes in a tick into impulse, angular and touched, always in the same order, in float64,
/// and clears it. @param tips  of the styluses at the end of the tick, tissue frame [m]
void sumReactions(CpuLattice& lattice, const std::array<Vector3f, layout::kMaxStyluses>& tips,
                  layout::TickStats& stats);

/// The same of what obstacles gave. @param places  [obstacles] at the end of the tick, tissue frame [m]
void sumObstacles(CpuLattice& lattice, const std::vector<Vector3f>& places, layout::TickStats& stats);

}  // namespace viscera
