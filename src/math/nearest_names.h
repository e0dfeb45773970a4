// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace viscera {

/// Returns the names, nearest first: up to three names with the fewest letters that are wrong, missing, surplus or
/// exchanged with their neighbour. The others keep their order.
std::vector<std::string> nearestFirst(const std::string& word, std::vector<std::string> names);
/// Returns the same as text, separated by commas.
std::string nearestFirstText(const std::string& word, const std::vector<std::string>& names);

}  // namespace viscera
