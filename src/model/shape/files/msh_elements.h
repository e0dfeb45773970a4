// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "viscera/math/types.h"

namespace viscera {

/// Type of elements in Gmsh files.
struct MshType {
  const char* name;
  size_t nodes, corners;
  int dimension;
  std::vector<std::vector<size_t>> faces;  ///< of three dimensions: corners, counter-clockwise seen from outside
  /// For second order: the two ends of each edge; the nodes of edges follow the corners.
  std::vector<std::array<size_t, 2>> edges;
};

/// Returns the element type of a Gmsh number; null: a type that is not read, of third order or unknown.
const MshType* mshType(int64_t number);

/// Appends triangles of a face, the same as those of the element on its other side.
/// @param nodes  of the element   @param face  index within its type
void appendFace(const MshType& type, size_t face, const std::vector<uint32_t>& nodes,
                std::vector<std::array<uint32_t, 3>>& triangles);

}  // namespace viscera
