// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <istream>
#include <string>
#include <vector>

namespace viscera {

struct PlyProperty {
  std::string name;
  std::string type;
  std::string list_type;  ///< type of a list's length; empty for a single value
};

struct PlyElement {
  std::string name;
  long long count = 0;
  std::vector<PlyProperty> properties;
};

/// Header of a PLY file.
struct PlyHeader {
  std::string format;  ///< ascii, binary_little_endian or binary_big_endian
  std::vector<PlyElement> elements;
};

/// Reads up to and including the line "end_header".
/// @throws MeshError  malformed, or without an end
PlyHeader readPlyHeader(std::istream& file);

/// Returns the bytes of a value of a PLY type; 0 for an unknown type.
size_t plyTypeBytes(const std::string& type);

}  // namespace viscera
