// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/files/ply_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <vector>

#include "math/number_text.h"
#include "model/shape/files/ply_header.h"
#include "model/shape/files/read_parts.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

template <typename T>
double valueOf(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return static_cast<double>(value);
}

/// Numbers of a body in sequence.
class PlyNumbers {
 public:
  PlyNumbers(std::istream& file, const std::string& format)
      : file_(file), is_ascii_(format == "ascii"), is_big_endian_(format == "binary_big_endian") {}

  double next(const std::string& type) { return is_ascii_ ? nextWord() : nextBytes(type); }

  /// Returns the length of a list.
  size_t nextLength(const std::string& type) {
    const double length = next(type);
    if (!(length >= 0 && length <= kLongestList)) throw MeshError("the length of a list is invalid");
    return static_cast<size_t>(length);
  }

 private:
  double nextWord() {
    if (!(file_ >> word_)) throw MeshError("");
    const std::optional<double> value = readNumber(word_);
    if (!value) throw MeshError("'" + word_ + "' is not a number");
    return *value;
  }

  double nextBytes(const std::string& type) {
    const size_t count = plyTypeBytes(type);
    char bytes[8];
    if (!file_.read(bytes, static_cast<std::streamsize>(count))) throw MeshError("");
    // Machines that viscera runs on are little-endian.
    if (is_big_endian_) std::reverse(bytes, bytes + count);
    const bool is_unsigned = type[0] == 'u';
    if (type[0] == 'f' || type[0] == 'd') return count == 4 ? valueOf<float>(bytes) : valueOf<double>(bytes);
    if (count == 1) return is_unsigned ? valueOf<uint8_t>(bytes) : valueOf<int8_t>(bytes);
    if (count == 2) return is_unsigned ? valueOf<uint16_t>(bytes) : valueOf<int16_t>(bytes);
    return is_unsigned ? valueOf<uint32_t>(bytes) : valueOf<int32_t>(bytes);
  }

  static constexpr double kLongestList = 1 << 24;
  std::istream& file_;
  bool is_ascii_, is_big_endian_;
  std::string word_;
};

unsigned vertexIndex(double value, size_t vertices) {
  if (value >= 0 && value < static_cast<double>(vertices)) return static_cast<unsigned>(value);
  throw MeshError("a face refers to a vertex that does not exist");
}

void readVertex(const PlyElement& element, PlyNumbers& numbers, ReadPart& mesh) {
  aiVector3D position(0, 0, 0);
  for (const PlyProperty& property : element.properties) {
    const size_t values = property.list_type.empty() ? 1 : numbers.nextLength(property.list_type);
    for (size_t i = 0; i < values; ++i) {
      const double value = numbers.next(property.type);
      if (property.name.size() == 1 && property.name[0] >= 'x' && property.name[0] <= 'z') {
        position[static_cast<unsigned>(property.name[0] - 'x')] = static_cast<float>(value);
      }
    }
  }
  mesh.vertices.push_back(position);
}

/// Reads faces, and skips other elements: corners are taken from a list of vertex indices.
void readFace(const PlyElement& element, PlyNumbers& numbers, ReadPart& mesh) {
  for (const PlyProperty& property : element.properties) {
    const size_t values = property.list_type.empty() ? 1 : numbers.nextLength(property.list_type);
    const bool are_corners = property.name == "vertex_indices" || property.name == "vertex_index";
    unsigned first = 0, last = 0;
    for (size_t i = 0; i < values; ++i) {
      const double value = numbers.next(property.type);
      if (!are_corners) continue;
      const unsigned corner = vertexIndex(value, mesh.vertices.size());
      if (i == 0) first = corner;
      if (i >= 2) mesh.triangles.push_back({first, last, corner});
      last = corner;
    }
  }
}

/// Reads triangle strips, with alternating orientation; -1 ends a strip.
void readStrips(const PlyElement& element, PlyNumbers& numbers, ReadPart& mesh) {
  for (const PlyProperty& property : element.properties) {
    const size_t values = property.list_type.empty() ? 1 : numbers.nextLength(property.list_type);
    std::vector<unsigned> strip;
    for (size_t i = 0; i < values; ++i) {
      const double value = numbers.next(property.type);
      if (property.name != "vertex_indices" && property.name != "vertex_index") continue;
      if (value == -1) {
        strip.clear();
        continue;
      }
      strip.push_back(vertexIndex(value, mesh.vertices.size()));
      const size_t n = strip.size();
      if (n < 3) continue;
      const bool turned = n % 2 == 0;
      mesh.triangles.push_back({strip[n - (turned ? 2 : 3)], strip[n - (turned ? 3 : 2)], strip[n - 1]});
    }
  }
}

void readElement(const PlyElement& element, PlyNumbers& numbers, ReadPart& mesh) {
  if (element.properties.empty()) return;
  const auto read = element.name == "vertex" ? readVertex : element.name == "tristrips" ? readStrips : readFace;
  for (long long i = 0; i < element.count; ++i) {
    try {
      read(element, numbers, mesh);
    } catch (const MeshError& error) {
      const std::string what = error.what();
      throw MeshError("in " + element.name + " " + std::to_string(i) + ": " + (what.empty() ? "the file ends" : what));
    }
  }
}

}  // namespace

bool isPly(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  char magic[3];
  return file.read(magic, sizeof magic) && std::memcmp(magic, "ply", sizeof magic) == 0;
}

std::unique_ptr<aiScene> readPly(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  const PlyHeader header = readPlyHeader(file);
  PlyNumbers numbers(file, header.format);
  ReadPart mesh;
  for (const PlyElement& element : header.elements) readElement(element, numbers, mesh);
  return sceneOf({mesh});
}

}  // namespace viscera
