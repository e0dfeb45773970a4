// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/model/model.h"

namespace viscera {

/// The explicit connections of all bodies of a model as one, as every backend holds them: slots of body b behind those
/// of the bodies before it, springs and links likewise.
struct JoinedNetwork {
  std::vector<uint32_t> starts;             ///< [slots + 1] first link of a node; none for nodes of implicit lattices
  std::vector<layout::Link> links;          ///< [2 * springs]
  std::vector<layout::SpringEnds> springs;  ///< [springs]
  std::vector<layout::vec4> rest_m;         ///< [slots] xyz rest position, of all bodies
  std::vector<float> masses_kg;             ///< [slots] of all bodies; 1 where no node is
};
/// Empty where no body has explicit connections.
JoinedNetwork joinNetworks(const Model& model);

/// Takes the stiffness from both links of the springs that are cut. @param spring_cut  [springs] as in CutSprings
void eraseSprings(const std::vector<float>& spring_cut, const std::vector<layout::SpringEnds>& springs,
                  std::vector<layout::Link>& links);

}  // namespace viscera
