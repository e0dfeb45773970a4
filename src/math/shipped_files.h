// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace viscera {

/// Returns the file itself if there is one, or if the name has a '/'; else the shipped one of that name; else nothing.
/// Shipped files are looked for below share/viscera of each folder that the program, or this library, is in, and in the
/// source tree that these were built from.
/// @param kind  "scenes", "tasks": a folder of config/   @param last  another folder config/, for want of these
std::string shippedFile(const std::string& name, const std::string& kind, const std::string& last = "");
/// Returns the names of the shipped files of a kind, sorted, from the first of these folders that has any.
std::vector<std::string> shippedNames(const std::string& kind, const std::string& last = "");

}  // namespace viscera
