// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/model/lattice.h"
#include "viscera/model/scene.h"

namespace viscera {

/// Sets kFixedBit on the nodes that the body's fixed entries match. Shapes are in the body's frame; a node on the
/// border of a shape belongs to it, and a node belongs to a part if a cell of that part touches it.
/// @param solid  the one that `lattice` was built from
/// @return  number of nodes fixed
/// @throws SceneError  an entry that matches no node, or that names a part that does not exist; lists the parts
size_t fixNodes(const BodyConfig& config, const Solid& solid, Lattice& lattice);

}  // namespace viscera
