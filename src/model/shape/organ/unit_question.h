// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viscera/math/types.h"
#include "viscera/model/scene/body_config.h"

namespace viscera {

/// Width of a body [m] above which its file is likely in another unit than metres.
constexpr double kWidestOrgan_m = 2;

/// Returns the width of a mesh file and the unit that it is likely in, as a question:
/// "mesh file 'heart.obj' is 100 m wide: unit_scale_m=0.001 (millimetres)?".
/// @param size_m  of its box, with the body's unit   @param usual_m  width that is expected
std::string unitQuestion(const BodyConfig& config, const Vector3d& size_m, double usual_m = 0.1);

}  // namespace viscera
