// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace viscera {

struct Scene;

/// Returns all keys of a scene with their values, one `key=value` per line, numbers to the bit. Two scenes with the
/// same text differ at most in the content of their files.
std::string sceneText(const Scene& scene);

}  // namespace viscera
