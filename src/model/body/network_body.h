// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "model/body/fixed_nodes.h"
#include "model/shape/organ/tissue.h"

namespace viscera {

/// Returns a body with name, material and colour as configured.
Body plainBody(const BodyConfig& config);

/// Returns a body of structure surface with notes on its construction; nothing fixed, no surface mesh.
/// @param parts  set to the parts of its surface, if not null
/// @throws LatticeError  spacing_m or target_nodes out of reach, no triangle with an area
Body networkBody(const BodyConfig& config, const Tissue& tissue, const Progress& progress, PartNodes* parts = nullptr);

}  // namespace viscera
