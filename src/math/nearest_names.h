// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace viscera {

/// Returns the names with those first, three at most, that a mistyped word is nearest to: by letters that are wrong,
/// missing, too many or exchanged with their neighbour. The others keep their order.
std::vector<std::string> nearestFirst(const std::string& word, std::vector<std::string> names);
/// Returns the same as a text, a comma between two.
std::string nearestFirstText(const std::string& word, const std::vector<std::string>& names);

}  // namespace viscera
