// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace viscera {

/// Reserves memory for `count` elements and for growth in later ticks. An assignment alone would allocate what it needs
/// again in every tick that cuts.
template <class Element>
void keepRoom(std::vector<Element>& in, size_t count) {
  constexpr size_t kFirst = 4096;
  if (in.capacity() < count) in.reserve(std::max(2 * count, kFirst));
}

/// Appends an element, with memory for later ones.
template <class Element>
void appendTo(std::vector<Element>& list, const Element& element) {
  keepRoom(list, list.size() + 1);
  list.push_back(element);
}

}  // namespace viscera
