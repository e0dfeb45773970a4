// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <yaml-cpp/exceptions.h>

#include <string>

namespace viscera {

/// Returns an error of the YAML parser with file, line and reason; tabs and wrong indents are named as such.
/// @param text  of the file
std::string yamlFault(const std::string& file, const YAML::Exception& error, const std::string& text);

}  // namespace viscera
