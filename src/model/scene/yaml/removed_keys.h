// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace viscera {

/// Returns what a scene file should have in place of a key or a value that viscera had once; empty: it never had it.
/// @param key    with its path, as solver.integrator or bodies[0].structure
/// @param value  of the key; empty for a key that is gone altogether
std::string removedNote(const std::string& key, const std::string& value = {});

}  // namespace viscera
