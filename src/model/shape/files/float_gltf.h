// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

#include "viscera/model/scene/body_config.h"

namespace viscera {

/// Returns a glTF or GLB file whose attributes are whole numbers (KHR_mesh_quantization, or coordinates of textures) as
/// files of real numbers, by path: the file itself, and one of numbers beside it, neither of which is written anywhere.
/// assimp (5.2) takes the bytes of such numbers for reals.
/// @throws MeshError  an accessor reaches beyond its buffer, or is of a kind that is not read
std::map<std::string, std::string> withFloatAttributes(const std::string& path, const ImportLimits& limits);

}  // namespace viscera
