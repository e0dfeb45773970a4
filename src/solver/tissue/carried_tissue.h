// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "viscera/model/model.h"
#include "viscera/solver/state.h"

namespace viscera {

/// Tissue in a state, which other lattices of the same bodies are to go on with.
struct CarriedTissue {
  std::shared_ptr<const Model> model;
  HostState state;
};

/// The same state of other lattices. Displacements and velocities are interpolated between the old nodes on the same
/// side of every cut, linear ones exactly. A spring is cut where the old nodes next to its ends were joined at rest
/// near it and are not any more, so that cuts shorter than the new lattice can hold are whole again; it is lost with an
/// end where the old node was. Bodies whose nodes are the same have their state as it is. Nothing is held.
/// @param to  the same bodies in the same order   @param rest  state of `to` at rest, as Solver::readState() gives it
HostState carriedState(const CarriedTissue& from, const Model& to, HostState rest);

}  // namespace viscera
