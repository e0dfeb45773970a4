// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace viscera {

struct Scene;

/// A scene file of all keys with the values that they have, numbers to the bit: parseScene() makes the same scene of
/// it, but for `folder`, where relative files are looked up, and `file`.
std::string resolvedYaml(const Scene& scene);

}  // namespace viscera
