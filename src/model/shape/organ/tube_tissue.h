// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "model/shape/organ/tissue.h"
#include "viscera/model/scene/body_config.h"

namespace viscera {

/// Makes the tissue of a body with source tube.
/// @throws SceneError  as HollowTube
std::unique_ptr<Tissue> tubeTissue(const BodyConfig& config);

}  // namespace viscera
