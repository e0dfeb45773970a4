// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "viscera/api.h"
#include "viscera/layout/limits.h"
#include "viscera/layout/nodes.h"

namespace VISCERA_PUBLIC viscera {

/// Buffers of the state of all nodes, as surface/ and render/ need them. Buffer names are OpenGL's.
struct StateView {
  uint32_t displacement = 0;  ///< vec4[slots], xyz m from rest
  uint32_t velocity = 0;      ///< vec4[slots], xyz m/s
  uint32_t nodes = 0;         ///< NodeBits[slots]
  uint32_t bricks = 0;        ///< Brick[bricks]
  uint32_t bodies = 0;        ///< BodyParams[bodies]
  uint32_t rest = 0;          ///< vec4[slots] rest positions [m]; 0 where no body has explicit connections
  uint32_t spring_cut = 0;    ///< float[springs], see layout::kBindSpringCut; 0 where no body has explicit connections
  uint32_t axial_cut = 0;     ///< float[3 * slots], as in CutSprings of implicit lattices; 0 without a tool that cuts
  uint64_t cut_revision = 0;  ///< grows whenever springs may have been cut since the last step
  uint32_t stale_bricks = 0;  ///< uint[bricks]: `revision` at which a node of the brick or of a neighbouring brick last
                              ///< moved; 0 where unknown: every node may have moved
  uint32_t revision = 0;      ///< revision of the state, > 0, growing
  uint32_t moved_revision = 0;  ///< revision at which some node last moved; 0 where unknown
};

/// Cut springs, and the position of each cut.
struct CutSprings {
  std::vector<layout::NodeBits> nodes;  ///< [slots]
  /// [springs] of the networks of all bodies, in the model's order: 0 whole, else the position 0..1 from a to b at
  /// which the blade crossed the spring, or layout::kErasedShare; empty where there are none
  std::vector<float> spring_cut;
  /// [3 * slots] of lattices, implicit and explicit: where the springs from a node to its neighbours along +x, +y and
  /// +z were first cut. 0: whole, or no spring there. 0.02 to 0.98: share of the line between the two nodes, starting
  /// from the node, at which it passes the plane of the blade's sweep. layout::kErasedShare: an end was erased, the one
  /// without a spring left in NodeBits. Empty where no tool cuts, or no body is a lattice.
  std::vector<float> axial_cut{};
};

/// State on the host as far as its display needs it. The display code keeps one and names the bricks that it needs.
/// CutSprings is copied only if empty, or of another cut_revision.
struct StateSnapshot : CutSprings {
  std::vector<uint32_t> bricks;       ///< [shown] bricks, ascending; set by the caller
  std::vector<float> displacement_m;  ///< [192 * shown] displacement [m] of each of the bricks: 64 x, 64 y, 64 z
  uint64_t cut_revision = 0;          ///< revision of CutSprings, as in StateView
};
constexpr size_t kBrickFloats = size_t{3} * layout::kBrickSlots;

/// Copies the displacements of the bricks that a snapshot names.
/// @param displacement_m  [192 * bricks] of all bricks, each 64 x, 64 y, 64 z
void copyShown(const float* displacement_m, StateSnapshot& out);

/// Copy of the state on the host, for hashes, saved states and tests.
struct HostState : CutSprings {
  std::vector<layout::vec4> displacement_m;    ///< [slots]
  std::vector<layout::vec4> velocity_m_per_s;  ///< [slots]
};

/// Cuts, kept by code that follows them (Solver::readCuts); empty before the first reading.
struct CutState : CutSprings {
  uint64_t revision = 0;  ///< revision of these cuts; grows like StateView::cut_revision
};

/// Copies from a state what a snapshot asks for. Nodes and springs are copied only if they differ from the snapshot's;
/// its cut_revision then grows.
void copyShown(const HostState& state, StateSnapshot& out);

}  // namespace viscera
