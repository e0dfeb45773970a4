// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "viscera/math/types.h"

namespace viscera {

/// Type of elements that Gmsh files hold.
struct MshType {
  const char* name;
  size_t nodes, corners;
  int dimension;
  std::vector<std::vector<size_t>> faces;    ///< of three dimensions: corners, counter-clockwise seen from outside
  std::vector<std::array<size_t, 2>> edges;  ///< of second order: the ends of each, whose nodes follow the corners
};

/// Returns what Gmsh has under a number; null: a type that is not read, of third order or unknown.
const MshType* mshType(int64_t number);

/// Appends triangles of a face, in an order in which an element on its other side has them too.
/// @param nodes  of the element   @param face  of its type
void appendFace(const MshType& type, size_t face, const std::vector<uint32_t>& nodes,
                std::vector<std::array<uint32_t, 3>>& triangles);

}  // namespace viscera
