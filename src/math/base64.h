// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace viscera {

/// Returns bytes as base64 (RFC 4648), with padding and without line breaks.
std::string base64(std::string_view bytes);

}  // namespace viscera
