// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "viscera/model/model.h"

namespace viscera {

/// Masses of the nodes that processes push, [slots of the model]; 0 for fixed and missing nodes.
struct NodeMasses {
  explicit NodeMasses(const Model& model);
  std::vector<float> kg, inverse_per_kg;
};

}  // namespace viscera
