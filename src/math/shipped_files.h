// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace viscera {

/// Returns the file itself if it exists, or if the name has a '/'; else the shipped file of that name; else nothing.
/// Searches share/viscera in each parent folder of the program or of this library, then the source tree of the build.
/// @param kind  "scenes", "tasks": a folder of config/   @param last  another folder config/, searched last
std::string shippedFile(const std::string& name, const std::string& kind, const std::string& last = "");
/// Returns the names of the shipped files of a kind, sorted, from the first of these folders that has any.
std::vector<std::string> shippedNames(const std::string& kind, const std::string& last = "");

}  // namespace viscera
