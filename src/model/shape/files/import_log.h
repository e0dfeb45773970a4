// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace viscera {

/// Returns the errors that assimp writes to its log while `read` runs: some readers mend a faulty file in silence. One
/// thread at a time; where the program has a logger of assimp's already, nothing is seen.
std::vector<std::string> assimpErrorsOf(const std::function<void()>& read);

/// @throws MeshError  one of these errors is about a face that refers to a vertex that does not exist
void requireVerticesOfFaces(const std::vector<std::string>& errors);

}  // namespace viscera
