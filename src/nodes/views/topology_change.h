// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

namespace viscera::nodes {

/// Changes between two lists of triangles: in the order of the old list, positions at which triangles are removed and
/// added. Arrays have one entry per position, except `triangles`.
struct TriangleEdits {
  std::vector<uint32_t> kept;       ///< number of triangles of the old list between the previous position and this one
  std::vector<uint32_t> removed;    ///< number of triangles of the old list that are removed here
  std::vector<uint32_t> added;      ///< number of triangles of `triangles` that replace them
  std::vector<uint32_t> triangles;  ///< [3 * sum of added] vertex indices
};

/// Returns the edits between two lists in similar order, such as those of a surface before and after a cut. It searches
/// for common triangles only a short distance ahead, so the time is linear in the lengths. The result is correct for
/// any two lists.
/// @param before, after  [3 * n] vertex indices
TriangleEdits editsBetween(const std::vector<uint32_t>& before, const std::vector<uint32_t>& after);

/// Returns the second list. @param before  first list of editsBetween()
std::vector<uint32_t> edited(const std::vector<uint32_t>& before, const TriangleEdits& edits);

}  // namespace viscera::nodes
