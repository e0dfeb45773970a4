// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "viscera/model/model.h"

namespace viscera {

struct BodyConfig;

/// The named parts of a body, as far as they hold nodes.
struct PartNodes {
  std::vector<std::string> names;
  /// Slots of the nodes of part `label` - 1; a slot may stand several times.
  std::function<std::vector<uint32_t>(uint16_t label)> slots;
};

/// Corners of the cells of a part.
/// @param solid  the one that `lattice` was built from
std::vector<uint32_t> slotsOfPart(uint16_t label, const Solid& solid, const Lattice& lattice);

/// Sets kFixedBit on the nodes that the body's fixed entries match. Shapes are in the body's frame; a node on the
/// border of a shape belongs to it, and a node belongs to a part if a cell or triangle of that part touches it. Where
/// cells are tissue in part, nodes within half a cell of a shape are held too: the tissue behind the last held ones is
/// rigid, so that it ends at the border on average, where nodes inside alone would leave up to a cell of it free. Of
/// a face between held nodes whose cell is tissue in part, on the border of what is held, the nodes are free unless the
/// tissue reaches it.
/// @return  number of nodes fixed
/// @throws SceneError  an entry that matches no node, or that names a part that does not exist; lists the parts
size_t fixNodes(const BodyConfig& config, const PartNodes& parts, Body& body);

}  // namespace viscera
