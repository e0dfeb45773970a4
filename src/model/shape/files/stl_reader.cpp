// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/files/stl_reader.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstring>
#include <fstream>
#include <sstream>

#include "model/shape/files/read_parts.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

constexpr size_t kHeaderBytes = 84, kTriangleBytes = 50;

std::string lowered(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

std::string contentsOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream all;
  all << file.rdbuf();
  return all.str();
}

/// Words of a text, with their lines.
class Words {
 public:
  explicit Words(const std::string& text) : text_(text) {}

  /// Reads the next word. False: the text ends.
  bool next(std::string& word) {
    while (at_ < text_.size() && isBlank(text_[at_])) line_ += text_[at_++] == '\n';
    const size_t first = at_;
    while (at_ < text_.size() && !isBlank(text_[at_])) ++at_;
    word.assign(text_, first, at_ - first);
    return at_ > first;
  }
  std::string restOfLine() {
    const size_t end = std::min(text_.find('\n', at_), text_.size());
    std::string rest = text_.substr(at_, end - at_);
    at_ = end;
    const auto blank = [](char c) { return isBlank(c); };
    rest.erase(rest.begin(), std::find_if_not(rest.begin(), rest.end(), blank));
    while (!rest.empty() && isBlank(rest.back())) rest.pop_back();
    return rest;
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw MeshError("in line " + std::to_string(line_) + ": " + what);
  }
  float number() {
    std::string word;
    if (!next(word)) fail("the file ends within a facet");
    const char* begin = word.data() + (word[0] == '+' ? 1 : 0);
    double value = 0;
    const auto result = std::from_chars(begin, word.data() + word.size(), value);
    const bool in_range = result.ec == std::errc() || result.ec == std::errc::result_out_of_range;
    if (!in_range || result.ptr != word.data() + word.size()) fail("'" + word + "' is not a number");
    return static_cast<float>(value);
  }

 private:
  static bool isBlank(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }
  const std::string& text_;
  size_t at_ = 0, line_ = 1;
};

/// Reader of the solids of a text STL file, one facet after the other.
class StlText {
 public:
  explicit StlText(const std::string& text) : words_(text) {}

  std::vector<ReadPart> read(std::vector<std::string>& notes) {
    std::string word;
    while (words_.next(word)) take(lowered(word));
    if (in_facet_) words_.fail("the file ends within a facet");
    if (in_solid_) notes.push_back("has no 'endsolid' at its end: it may be truncated");
    return std::move(parts_);
  }

 private:
  void take(const std::string& word) {
    if (word == "solid") {
      parts_.push_back({words_.restOfLine(), {}, {}});
      in_solid_ = true;
    } else if (word == "endsolid") {
      words_.restOfLine();
      in_solid_ = false;
    } else if (word == "facet") {
      in_facet_ = true;
      words_.restOfLine();  // its normal
    } else if (word == "vertex") {
      if (parts_.empty() || !in_facet_) words_.fail("a vertex is outside of any facet");
      const float x = words_.number(), y = words_.number(), z = words_.number();
      parts_.back().vertices.emplace_back(x, y, z);
      ++corners_;
    } else if (word == "endloop") {
      addFan();
    } else if (word == "endfacet") {
      in_facet_ = false;
    } else if (word != "outer" && word != "loop") {
      words_.fail("'" + word + "' is not an STL keyword");
    }
  }

  void addFan() {
    const auto first = static_cast<unsigned>(parts_.empty() ? 0 : parts_.back().vertices.size() - corners_);
    for (unsigned c = 2; c < corners_; ++c) parts_.back().triangles.push_back({first, first + c - 1, first + c});
    corners_ = 0;
  }

  Words words_;
  std::vector<ReadPart> parts_;
  unsigned corners_ = 0;
  bool in_solid_ = false, in_facet_ = false;
};

/// Returns how many triangles to read of a binary file; its header is often wrong if it was written as a stream.
size_t trianglesOf(const std::string& bytes, std::vector<std::string>& notes) {
  uint32_t said = 0;
  std::memcpy(&said, bytes.data() + kHeaderBytes - sizeof said, sizeof said);
  const size_t body = bytes.size() - kHeaderBytes, held = body / kTriangleBytes, rest = body % kTriangleBytes;
  if (said == held && rest == 0) return held;
  const bool unknown = said == 0 || said == UINT32_MAX;
  if (said > held && !unknown)
    throw MeshError("its header announces " + std::to_string(said) + " triangles, but it has " + std::to_string(held));
  const size_t count = rest == 0 || unknown ? held : said;
  if (count != said)
    notes.push_back("its header announces " + std::to_string(said) + " triangles; all " + std::to_string(count) +
                    " are read");
  const size_t behind = body - count * kTriangleBytes;
  if (behind > 0) notes.push_back(std::to_string(behind) + " bytes after its last triangle are ignored");
  return count;
}

ReadPart readBinary(const std::string& bytes, std::vector<std::string>& notes) {
  if (bytes.size() < kHeaderBytes) throw MeshError("it ends within the header");
  ReadPart part;
  const size_t count = trianglesOf(bytes, notes);
  part.vertices.reserve(3 * count);
  for (size_t t = 0; t < count; ++t) {
    const char* const corners = bytes.data() + kHeaderBytes + t * kTriangleBytes + 3 * sizeof(float);  // after a normal
    for (size_t c = 0; c < 3; ++c) {
      float p[3];
      std::memcpy(p, corners + c * sizeof p, sizeof p);
      part.vertices.emplace_back(p[0], p[1], p[2]);
    }
    const auto first = static_cast<unsigned>(3 * t);
    part.triangles.push_back({first, first + 1, first + 2});
  }
  return part;
}

/// Returns whether a file is text: binary files may begin with "solid" too, but a text has facets in its first lines,
/// and no byte 0.
bool isText(const std::string& bytes) {
  constexpr size_t kLooked = 1000;
  const std::string head = lowered(bytes.substr(0, kLooked));
  const size_t first = head.find_first_not_of(" \t\r\n\f\v");
  if (first == std::string::npos || head.compare(first, 5, "solid") != 0) return false;
  if (head.find('\0') != std::string::npos) return false;
  return head.find("facet") != std::string::npos || head.find("endsolid") != std::string::npos;
}

}  // namespace

bool isStl(const std::string& path) {
  constexpr size_t kEnding = 4;
  return path.size() > kEnding && lowered(path.substr(path.size() - kEnding)) == ".stl";
}

std::unique_ptr<aiScene> readStl(const std::string& path, std::vector<std::string>& notes) {
  const std::string bytes = contentsOf(path);
  if (isText(bytes)) return sceneOf(StlText(bytes).read(notes));
  return sceneOf({readBinary(bytes, notes)});
}

}  // namespace viscera
