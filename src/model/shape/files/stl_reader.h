// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <assimp/scene.h>

#include <memory>
#include <string>
#include <vector>

namespace viscera {

/// Returns whether a file is STL by its name.
bool isStl(const std::string& path);

/// Reads an STL file, text or binary, whatever it begins with; each solid of a text becomes a mesh of its name. assimp
/// (5.2) accepts neither if there is a byte too many or too few at the end.
/// @param notes  get oddities that are no errors, one line each
/// @throws MeshError  the file is corrupt or cut short; says where, without the file's name
std::unique_ptr<aiScene> readStl(const std::string& path, std::vector<std::string>& notes);

}  // namespace viscera
