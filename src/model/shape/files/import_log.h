// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace viscera {

/// Returns the errors that assimp logs while `read` runs: some readers silently repair a faulty file. One thread at a
/// time. Returns nothing if the program already has an assimp logger.
std::vector<std::string> assimpErrorsOf(const std::function<void()>& read);

/// Checks the errors of a log.
/// @throws MeshError  one of these errors is about a face that refers to a missing vertex
void requireVerticesOfFaces(const std::vector<std::string>& errors);

}  // namespace viscera
