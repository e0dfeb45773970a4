// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace viscera::nodes {

/// What turns one list of triangles into another: in the order of the old list, places where some go and others come.
/// Arrays are [places] but for `triangles`.
struct TriangleEdits {
  std::vector<uint32_t> kept;       ///< triangles of the old list before this place and after the last one
  std::vector<uint32_t> removed;    ///< of the old list that follow
  std::vector<uint32_t> added;      ///< of `triangles` that come in their place
  std::vector<uint32_t> triangles;  ///< [3 * sum of added] vertex indices
};

/// Edits of lists that are made in one order, as those of a skin before and after a cut are: looks for what stays a
/// short way ahead only, in time that grows with the lists and not with their product. Right for any two lists.
/// @param before, after  [3 * n] vertex indices
TriangleEdits editsBetween(const std::vector<uint32_t>& before, const std::vector<uint32_t>& after);

/// The second list. @param before  the first one of editsBetween()
std::vector<uint32_t> edited(const std::vector<uint32_t>& before, const TriangleEdits& edits);

}  // namespace viscera::nodes
