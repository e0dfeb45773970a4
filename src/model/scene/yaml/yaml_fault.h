// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <yaml-cpp/exceptions.h>

#include <string>

namespace viscera {

/// Returns what YAML itself has against a file: file, line and what is wrong, with tabs and wrong indents called so.
/// @param text  of the file
std::string yamlFault(const std::string& file, const YAML::Exception& error, const std::string& text);

}  // namespace viscera
