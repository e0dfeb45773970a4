// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace viscera {

/// Makes room for `count` elements in a vector that is filled again in every tick that cuts, and for those of the ticks
/// to come: assignments alone would ask for as much as they need, in every tick again.
template <class Element>
void keepRoom(std::vector<Element>& in, size_t count) {
  constexpr size_t kFirst = 4096;
  if (in.capacity() < count) in.reserve(std::max(2 * count, kFirst));
}

/// Adds an element behind all, with room for those to come.
template <class Element>
void appendTo(std::vector<Element>& list, const Element& element) {
  keepRoom(list, list.size() + 1);
  list.push_back(element);
}

}  // namespace viscera
