// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/model/scene/body_config.h"

namespace viscera::bench {

/// Returns a block of tissue that is fixed at its bottom z = 0 and centred on the z axis.
/// @param size_m  > 0   @param spacing_m  node spacing
BodyConfig blockOnBone(const Vector3d& size_m, double spacing_m, double young_modulus_pa);

}  // namespace viscera::bench
