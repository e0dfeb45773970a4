// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "viscera/model/model.h"
#include "viscera/solver/state.h"

namespace viscera {

/// Tissue in a state from which other lattices of the same bodies continue.
struct CarriedTissue {
  std::shared_ptr<const Model> model;
  HostState state;
};

/// Returns the same state on other lattices. Displacements and velocities are interpolated between the old nodes on the
/// same side of every cut; linear fields exactly. A spring is cut if the old nodes next to its ends were connected near
/// it at rest and no longer are, so cuts shorter than the new lattice can represent heal. A spring is removed with an
/// end where the old node was removed. Bodies with the same nodes keep their state unchanged. Nothing is held.
/// @param to  the same bodies in the same order   @param rest  state of `to` at rest, from Solver::readState()
HostState carriedState(const CarriedTissue& from, const Model& to, HostState rest);

}  // namespace viscera
