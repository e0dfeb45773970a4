// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/model/model.h"

namespace viscera {

/// The explicit connections of all bodies of a model as one, as every backend holds them: the slots, springs and links
/// of body b follow those of the bodies before it.
struct JoinedNetwork {
  std::vector<uint32_t> starts;     ///< [slots + 1] first link of a node; no links for nodes of implicit lattices
  std::vector<layout::Link> links;  ///< [2 * springs]
  std::vector<layout::SpringEnds> springs;  ///< [springs]
  std::vector<layout::vec4> rest_m;         ///< [slots] xyz rest position [m], of all bodies
  std::vector<float> masses_kg;             ///< [slots] masses of all bodies [kg]; 1 in slots without a node
};
/// Joins the networks of a model. Empty if no body has explicit connections.
JoinedNetwork joinNetworks(const Model& model);

/// Sets the stiffness of both links of cut springs to 0. @param spring_cut  [springs] as in CutSprings
void eraseSprings(const std::vector<float>& spring_cut, const std::vector<layout::SpringEnds>& springs,
                  std::vector<layout::Link>& links);

}  // namespace viscera
