// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "layout/edge_forces.h"
#include "solver/tissue/joined_network.h"

namespace viscera {

/// Edge-centric forces (GW 4.2), as shaders/solver/tissue/spring_forces.comp finds them and the integrator sums them:
/// every spring is owned by one of its ends, which computes it once. Each node owns about as many, half of its springs,
/// so that processors that work on several nodes at once wait for none of them. An owner adds up what its own springs
/// do to it and stores that sum, and a force for each far end: half of the stores for both ends.
struct EdgeForces {
  std::vector<layout::SpringOwner> owners;  ///< [nodes that own springs] by slot
  /// [slots] its links: first and end of those of springs that it owns, which come node by node before all others, so
  /// that what is read together lies together; then first and end of the others. In place of JoinedNetwork::starts.
  std::vector<layout::uvec4> links;
  /// [slots + 1] first place of the forces on a node: the sum of its own springs', if it owns any, then one of each
  /// spring that the other end owns.
  std::vector<uint32_t> starts;

  /// Forces to allocate: one more than are written, as the integrator reads two at a time.
  size_t places() const { return starts.empty() ? 0 : size_t{starts.back()} + 1; }
};
/// Shares out the springs of a network: orders its links as EdgeForces::links says, after which its starts mean
/// nothing, and notes in them the place of the force on the far end. @return empty without explicit connections
EdgeForces orderByOwner(JoinedNetwork& network);

/// [springs] 1 where end b is the owner. No node owns more than the mean over nodes with springs, rounded up, if that
/// can be had by handing springs on; parts that are too dense for it come as near to it as they can.
std::vector<uint8_t> ownedByB(const std::vector<layout::SpringEnds>& springs, size_t slots);

}  // namespace viscera
