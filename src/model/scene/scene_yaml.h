// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace viscera {

struct Scene;

/// Returns a scene file of all keys with their values, numbers to the bit. parseScene() turns it into the same scene,
/// except for `folder`, where relative files are looked up, and `file`.
std::string resolvedYaml(const Scene& scene);

}  // namespace viscera
