// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "viscera/layout/limits.h"
#include "viscera/layout/nodes.h"

namespace viscera {

/// Where the state of all nodes lives: what surface/ and render/ need to know of a solver. Buffer names are OpenGL's.
struct StateView {
  uint32_t displacement = 0;    ///< vec4[slots], xyz m from rest
  uint32_t velocity = 0;        ///< vec4[slots], xyz m/s
  uint32_t nodes = 0;           ///< NodeBits[slots]
  uint32_t bricks = 0;          ///< Brick[bricks]
  uint32_t bodies = 0;          ///< BodyParams[bodies]
  uint32_t rest = 0;            ///< vec4[slots] rest positions [m]; 0 where no body has explicit connections
  uint32_t spring_cut = 0;      ///< float[springs], see layout::kBindSpringCut; 0 likewise
  uint32_t axial_cut = 0;       ///< float[3 * slots], as in CutSprings of implicit lattices; 0 without a tool that cuts
  uint64_t cut_revision = 0;    ///< grows whenever springs may have been cut since the last step
  uint32_t stale_bricks = 0;    ///< uint[bricks]: `revision` at which a node of the brick or of a brick beside it last
                                ///< moved; 0 where unknown: every node may have moved
  uint32_t revision = 0;        ///< of the state, > 0, growing
  uint32_t moved_revision = 0;  ///< at which some node last moved; 0 where unknown
};

/// Which springs are cut, and where.
struct CutSprings {
  std::vector<layout::NodeBits> nodes;  ///< [slots]
  /// [springs] of the networks of all bodies, in the model's order: 0 whole, else where the blade crossed it, 0..1 of
  /// the way from a to b, or layout::kErasedShare; empty where there are none
  std::vector<float> spring_cut;
  /// [3 * slots] of lattices, implicit and explicit: where the springs from a node to its neighbours along +x, +y and
  /// +z were first cut: 0 whole (or none there), else the share of the line between the two nodes, from the node on, at
  /// which it passes the plane of the blade's sweep, 0.02 to 0.98; layout::kErasedShare where an end was erased: the
  /// one that NodeBits says to have no spring left. Empty where no tool cuts, or no body is a lattice.
  std::vector<float> axial_cut{};
};

/// What showing a state that lives on the host takes of it. What shows it keeps one and says which bricks matter.
/// CutSprings is copied only if empty, or of another cut_revision.
struct StateSnapshot : CutSprings {
  std::vector<uint32_t> bricks;       ///< [shown] ascending; set by the caller
  std::vector<float> displacement_m;  ///< [192 * shown] of each of the bricks: 64 x, 64 y, 64 z
  uint64_t cut_revision = 0;          ///< as in StateView, of CutSprings
};
constexpr size_t kBrickFloats = size_t{3} * layout::kBrickSlots;

/// Copies the displacements of the bricks that a snapshot asks for.
/// @param displacement_m  [192 * bricks] of all bricks, each 64 x, 64 y, 64 z
void copyShown(const float* displacement_m, StateSnapshot& out);

/// Copy of the state on the host, for hashing, saving and tests.
struct HostState : CutSprings {
  std::vector<layout::vec4> displacement_m;    ///< [slots]
  std::vector<layout::vec4> velocity_m_per_s;  ///< [slots]
};

/// What follows cuts keeps one (Solver::readCuts); empty before the first reading.
struct CutState : CutSprings {
  uint64_t revision = 0;  ///< of what is here; grows like StateView::cut_revision
};

/// Copies what a snapshot asks for of a state: whole tissue, nodes and springs where they differ from the snapshot's,
/// which counts its cut_revision on then.
void copyShown(const HostState& state, StateSnapshot& out);

}  // namespace viscera
