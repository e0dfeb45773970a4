// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <assimp/scene.h>

#include <memory>
#include <string>

namespace viscera {

bool isPly(const std::string& path);

/// Reads a PLY file (ascii or binary) as one mesh of triangles; faces with more corners become fans. assimp's reader
/// (5.2) crashes or never returns where the file is cut short. It also misreads binary files if the first coordinate
/// starts with the byte of a blank or a line end.
/// @throws MeshError  the file is corrupt or cut short; says where, without the file's name
std::unique_ptr<aiScene> readPly(const std::string& path);

}  // namespace viscera
