// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/model/scene/body_config.h"

namespace viscera::bench {

/// A block of tissue that stands at z = 0 and is held there, centred on the z axis.
/// @param size_m  > 0   @param spacing_m  of nodes
BodyConfig blockOnBone(const Vector3d& size_m, double spacing_m, double young_modulus_pa);

}  // namespace viscera::bench
