// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace viscera {

/// Returns what replaces a key or value that an earlier version of viscera had; empty: it never existed.
/// @param key    with its path, as solver.integrator or bodies[0].structure
/// @param value  of the key; empty for a key that was removed altogether
std::string removedNote(const std::string& key, const std::string& value = {});

}  // namespace viscera
