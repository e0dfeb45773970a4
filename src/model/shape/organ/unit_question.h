// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viscera/math/types.h"
#include "viscera/model/scene/body_config.h"

namespace viscera {

/// Width of a body [m] above which its file is probably not in metres.
constexpr double kWidestOrgan_m = 2;

/// Returns the width of a mesh file and its probable unit, as a question:
/// "mesh file 'heart.obj' is 100 m wide: unit_scale_m=0.001 (millimetres)?".
/// @param size_m  of its box, in the body's unit   @param usual_m  expected width
std::string unitQuestion(const BodyConfig& config, const Vector3d& size_m, double usual_m = 0.1);

}  // namespace viscera
