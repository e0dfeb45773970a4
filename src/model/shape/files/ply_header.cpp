// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/files/ply_header.h"

#include <map>
#include <sstream>

#include "math/number_text.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

PlyElement readElement(std::istringstream& words) {
  PlyElement element;
  if (!(words >> element.name >> element.count) || element.count < 0)
    throw MeshError("its PLY header has an invalid element");
  return element;
}

PlyProperty readProperty(std::istringstream& words) {
  PlyProperty property;
  words >> property.type;
  if (property.type == "list") words >> property.list_type >> property.type;
  words >> property.name;
  const bool list_known = property.list_type.empty() || plyTypeBytes(property.list_type) > 0;
  if (!words || plyTypeBytes(property.type) == 0 || !list_known)
    throw MeshError("its PLY header has an invalid property");
  return property;
}

void requireFormat(const std::string& format) {
  if (format == "ascii" || format == "binary_little_endian" || format == "binary_big_endian") return;
  throw MeshError("its PLY header has no known format");
}

}  // namespace

size_t plyTypeBytes(const std::string& type) {
  static const std::map<std::string, size_t> bytes = {{"char", 1},  {"int8", 1},    {"uchar", 1},  {"uint8", 1},
                                                      {"short", 2}, {"int16", 2},   {"ushort", 2}, {"uint16", 2},
                                                      {"int", 4},   {"int32", 4},   {"uint", 4},   {"uint32", 4},
                                                      {"float", 4}, {"float32", 4}, {"double", 8}, {"float64", 8}};
  const auto found = bytes.find(type);
  return found == bytes.end() ? 0 : found->second;
}

PlyHeader readPlyHeader(std::istream& file) {
  PlyHeader header;
  for (std::string line; std::getline(file, line) && !file.eof();) {
    TextIn words(line);
    std::string keyword;
    words >> keyword;
    if (keyword == "end_header") {
      requireFormat(header.format);
      return header;
    }
    if (keyword == "format") words >> header.format;
    if (keyword == "element") header.elements.push_back(readElement(words));
    if (keyword != "property") continue;
    if (header.elements.empty()) throw MeshError("its PLY header has a property before any element");
    header.elements.back().properties.push_back(readProperty(words));
  }
  throw MeshError("its PLY header has no end");
}

}  // namespace viscera
