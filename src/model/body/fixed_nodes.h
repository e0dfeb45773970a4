// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "viscera/model/model.h"

namespace viscera {

struct BodyConfig;

/// Named parts of a body that contain nodes.
struct PartNodes {
  std::vector<std::string> names;
  /// Returns the slots of the nodes of part `label` - 1; a slot may occur several times.
  std::function<std::vector<uint32_t>(uint16_t label)> slots;
};

/// Returns the corners of the cells of a part.
/// @param solid  the solid that `lattice` was built from
std::vector<uint32_t> slotsOfPart(uint16_t label, const Solid& solid, const Lattice& lattice);

/// Sets kFixedBit on the nodes that the body's fixed entries match. Shapes are in the body's frame, and include their
/// border. A node belongs to a part if a cell or triangle of that part touches it.
///
/// Where cells are partly filled, nodes within half a cell of a shape are fixed too. Tissue behind the last fixed nodes
/// is rigid, so the rigid region then ends at the border on average; with inner nodes only, up to a cell of it would be
/// free. On the border of the fixed set, the nodes of a face of a partly filled cell are free unless tissue reaches
/// that face.
/// @return  number of nodes fixed
/// @throws SceneError  an entry that matches no node, or that names a part that does not exist; lists the parts
size_t fixNodes(const BodyConfig& config, const PartNodes& parts, Body& body);

}  // namespace viscera
