// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

#include "math/out_file.h"

namespace viscera {

/// Returns what a file holds. @param head  its first 64 KiB, not empty
FileKind kindOf(std::string_view head);
/// Returns the kind as a phrase for messages, such as "a saved state".
const char* nameOf(FileKind kind);

}  // namespace viscera
