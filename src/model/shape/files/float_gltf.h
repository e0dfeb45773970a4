// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

#include "viscera/model/scene/body_config.h"

namespace viscera {

/// Returns a glTF or GLB file with integer attributes (KHR_mesh_quantization, or texture coordinates) as files of real
/// numbers, by path: the file itself, and a file of numbers next to it. Neither is written to disk. assimp (5.2) reads
/// the bytes of such integers as reals.
/// @throws MeshError  an accessor reaches beyond its buffer, or is of a type that is not read
std::map<std::string, std::string> withFloatAttributes(const std::string& path, const ImportLimits& limits);

}  // namespace viscera
