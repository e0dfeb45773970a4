// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/files/msh_reader.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <unordered_map>

#include "math/memory_for.h"
#include "math/number_text.h"
#include "model/scene/file_bounds.h"
#include "model/shape/files/import_limits.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

constexpr uint64_t kPoint = 15, kTetrahedron = 4;

/// Corners of the elements that are read or passed over, by Gmsh's number of their type; 0: of no such type.
size_t cornersOf(uint64_t type) {
  constexpr size_t kCorners[] = {0, 2, 3, 4, 4};  // line, triangle, quadrangle, tetrahedron
  return type == kPoint ? 1 : type < std::size(kCorners) ? kCorners[type] : 0;
}

/// The lines of a file that hold something, as words.
class MshLines {
 public:
  explicit MshLines(const std::string& path) : path_(path), file_(path, std::ios::binary) {
    std::error_code error;
    if (std::filesystem::is_directory(path, error)) throw MeshError("mesh file '" + path + "' is a folder");
    if (!file_) throw MeshError("mesh file '" + path + "' cannot be read (does it exist?)");
  }

  bool next() {
    for (std::string text; std::getline(file_, text);) {
      ++line_;
      words_.clear();
      TextIn in(text);
      for (std::string word; in >> word;) words_.push_back(word);
      if (!words_.empty()) return true;
    }
    return false;
  }
  /// The next line, one of `section`.
  void need(const std::string& section) {
    if (!next()) fail("the file ends within $" + section);
    if (words_[0][0] == '$') fail(words_[0] + " where $" + section + " should go on: its counts do not match");
  }
  /// The line that closes a section.
  void needEnd(const std::string& section) {
    if (!next()) fail("the file ends within $" + section);
    if (words_[0] != "$End" + section) {
      fail("'" + words_[0] + "' where $End" + section + " should stand: the counts of $" + section + " do not match");
    }
  }
  void needWords(size_t least, size_t most) const {
    if (words_.size() >= least && words_.size() <= most) return;
    const std::string range =
        least == most ? std::to_string(least) : std::to_string(least) + " to " + std::to_string(most);
    fail("needs " + range + " numbers, has " + std::to_string(words_.size()));
  }

  const std::string& word(size_t i) const { return words_[i]; }
  size_t words() const { return words_.size(); }
  uint64_t whole(size_t i) const {
    const std::string& w = words_[i];
    constexpr size_t kMostDigits = 15;
    if (w.size() > kMostDigits || w.find_first_not_of("0123456789") != std::string::npos) {
      fail("'" + w + "' is not a whole number from 0 to 10^15");
    }
    return std::stoull(w);
  }
  double number(size_t i) const {
    const std::string& w = words_[i];
    const std::optional<double> value = readNumber(w);
    if (!value) fail("'" + w + "' is not a number");
    if (!std::isfinite(*value)) fail("'" + w + "' is not finite");
    return *value;
  }
  Vector3d point(size_t i) const { return {number(i), number(i + 1), number(i + 2)}; }

  [[noreturn]] void fail(const std::string& what) const {
    throw MeshError("mesh file '" + path_ + "', line " + std::to_string(line_) + ": " + what);
  }

 private:
  std::string path_;
  std::ifstream file_;
  size_t line_ = 0;
  std::vector<std::string> words_;
};

class MshReader {
 public:
  MshReader(const std::string& path, double unit_scale_m) : lines_(path), unit_scale_m_(unit_scale_m) {}

  void read() {
    readFormat();
    bool has_nodes = false, has_elements = false;
    while (lines_.next()) {
      const std::string section = sectionOf(lines_.word(0));
      if (section == "Nodes") {
        once(section, has_nodes);
        is_4_ ? readNodeBlocks() : readNodes();
        lines_.needEnd(section);
      } else if (section == "Elements") {
        once(section, has_elements);
        is_4_ ? readElementBlocks() : readElements();
        lines_.needEnd(section);
      } else {
        passOver(section);
      }
    }
    if (!has_nodes) lines_.fail("the file has no $Nodes");
    if (mesh_.tetrahedra.empty()) lines_.fail("the file has no tetrahedron (elements of type 4)");
  }

  /// The mesh without the nodes that only other elements have.
  TetrahedraMesh used(MshReport& report) const {
    constexpr uint32_t kUnused = std::numeric_limits<uint32_t>::max();
    std::vector<uint32_t> moved(mesh_.positions_m.size(), kUnused);
    TetrahedraMesh out;
    for (auto tetrahedron : mesh_.tetrahedra) {
      for (uint32_t& vertex : tetrahedron) {
        if (moved[vertex] == kUnused) {
          moved[vertex] = static_cast<uint32_t>(out.positions_m.size());
          out.positions_m.push_back(mesh_.positions_m[vertex]);
        }
        vertex = moved[vertex];
      }
      out.tetrahedra.push_back(tetrahedron);
    }
    report = report_;
    report.tetrahedra = out.tetrahedra.size();
    report.unused_nodes = mesh_.positions_m.size() - out.positions_m.size();
    return out;
  }

 private:
  void readFormat() {
    if (!lines_.next() || lines_.word(0) != "$MeshFormat") lines_.fail("a Gmsh file starts with $MeshFormat");
    lines_.need("MeshFormat");
    lines_.needWords(3, 3);
    report_.version = lines_.word(0);
    is_4_ = report_.version == "4.1";
    if (!is_4_ && report_.version != "2.2") {
      lines_.fail("version " + report_.version + " is not read; save it as MSH 2.2 or 4.1 (gmsh -format msh41)");
    }
    if (lines_.word(1) != "0") lines_.fail("binary files are not read; save it as ASCII (gmsh without -bin)");
    lines_.needEnd("MeshFormat");
  }

  std::string sectionOf(const std::string& word) const {
    if (word[0] != '$' || word.rfind("$End", 0) == 0) lines_.fail("'" + word + "' where a section should start");
    return word.substr(1);
  }
  void once(const std::string& section, bool& has) const {
    if (has) lines_.fail("a second $" + section);
    has = true;
  }
  void passOver(const std::string& section) {
    do {
      if (!lines_.next()) lines_.fail("the file ends within $" + section);
    } while (lines_.word(0) != "$End" + section);
  }

  void readNodes() {
    lines_.need("Nodes");
    lines_.needWords(1, 1);
    for (uint64_t left = lines_.whole(0); left > 0; --left) {
      lines_.need("Nodes");
      lines_.needWords(4, 4);
      addNode(lines_.whole(0), lines_.point(1));
    }
  }

  void readNodeBlocks() {
    lines_.need("Nodes");
    lines_.needWords(4, 4);
    const uint64_t blocks = lines_.whole(0), nodes = lines_.whole(1);
    for (uint64_t b = 0; b < blocks; ++b) {
      lines_.need("Nodes");
      lines_.needWords(4, 4);
      const bool is_parametric = lines_.whole(2) != 0;
      std::vector<uint64_t> tags;
      for (uint64_t left = lines_.whole(3); left > 0; --left) {
        lines_.need("Nodes");
        lines_.needWords(1, 1);
        tags.push_back(lines_.whole(0));
      }
      for (const uint64_t tag : tags) {
        lines_.need("Nodes");
        lines_.needWords(3, is_parametric ? 6 : 3);
        addNode(tag, lines_.point(0));
      }
    }
    requireCount("nodes", nodes, mesh_.positions_m.size());
  }

  void readElements() {
    lines_.need("Elements");
    lines_.needWords(1, 1);
    for (uint64_t left = lines_.whole(0); left > 0; --left) {
      lines_.need("Elements");
      lines_.needWords(3, std::numeric_limits<size_t>::max());
      const uint64_t type = lines_.whole(1);
      const size_t corners = requireType(type), first = 3 + static_cast<size_t>(lines_.whole(2));
      lines_.needWords(first + corners, first + corners);
      addElement(type, first);
    }
  }

  void readElementBlocks() {
    lines_.need("Elements");
    lines_.needWords(4, 4);
    const uint64_t blocks = lines_.whole(0), elements = lines_.whole(1);
    for (uint64_t b = 0; b < blocks; ++b) {
      lines_.need("Elements");
      lines_.needWords(4, 4);
      const uint64_t type = lines_.whole(2);
      const size_t corners = requireType(type);
      for (uint64_t left = lines_.whole(3); left > 0; --left) {
        lines_.need("Elements");
        lines_.needWords(1 + corners, 1 + corners);
        addElement(type, 1);
      }
    }
    requireCount("elements", elements, mesh_.tetrahedra.size() + report_.other_elements);
  }

  void addNode(uint64_t tag, const Vector3d& position) {
    const auto next = static_cast<uint32_t>(mesh_.positions_m.size());
    if (!node_of_tag_.try_emplace(tag, next).second) lines_.fail("node " + std::to_string(tag) + " stands twice");
    mesh_.positions_m.push_back(unit_scale_m_ * position);
  }

  size_t requireType(uint64_t type) const {
    const size_t corners = cornersOf(type);
    if (corners == 0) {
      lines_.fail("elements of type " + std::to_string(type) +
                  " are not read: only 4-node tetrahedra (type 4), beside points, lines, triangles and quadrangles of "
                  "first order, which are passed over");
    }
    return corners;
  }

  /// @param first  word of the first corner
  void addElement(uint64_t type, size_t first) {
    if (type != kTetrahedron) {
      ++report_.other_elements;
      return;
    }
    std::array<uint32_t, 4> tetrahedron;
    for (size_t c = 0; c < 4; ++c) {
      const auto node = node_of_tag_.find(lines_.whole(first + c));
      if (node == node_of_tag_.end()) lines_.fail("node " + lines_.word(first + c) + " is not known");
      tetrahedron[c] = node->second;
    }
    mesh_.tetrahedra.push_back(facingPositive(tetrahedron));
  }

  std::array<uint32_t, 4> facingPositive(std::array<uint32_t, 4> tetrahedron) {
    constexpr double kFlat = 1e-12;  // volume over the cube of the longest edge: rounding of double precision
    double longest_m = 0;
    for (size_t a = 0; a < 4; ++a) {
      for (size_t b = 0; b < a; ++b) {
        longest_m = std::max(longest_m, (mesh_.positions_m[tetrahedron[a]] - mesh_.positions_m[tetrahedron[b]]).norm());
      }
    }
    const double volume_m3 = signedVolume(mesh_, tetrahedron);
    if (!(std::abs(volume_m3) > kFlat * longest_m * longest_m * longest_m)) lines_.fail("the tetrahedron is flat");
    if (volume_m3 > 0) return tetrahedron;
    ++report_.turned;
    std::swap(tetrahedron[2], tetrahedron[3]);
    return tetrahedron;
  }

  void requireCount(const std::string& what, uint64_t announced, size_t read) const {
    if (announced == read) return;
    lines_.fail(std::to_string(announced) + " " + what + " announced, " + std::to_string(read) + " there");
  }

  MshLines lines_;
  double unit_scale_m_;
  bool is_4_ = false;
  TetrahedraMesh mesh_;
  std::unordered_map<uint64_t, uint32_t> node_of_tag_;
  MshReport report_;
};

}  // namespace

std::string MshReport::text() const {
  TextOut out;
  out << "MSH " << version << ", " << tetrahedra << " tetrahedra (" << turned
      << " of them turned inside out, turned back), passed over " << other_elements << " other elements, "
      << unused_nodes << " nodes";
  return out.str();
}

TetrahedraMesh readMsh(const std::string& path, double unit_scale_m, MshReport* report, const ImportLimits& limits) {
  if (!std::isfinite(unit_scale_m) || unit_scale_m <= 0) {
    throw MeshError("mesh file '" + path + "': unit_scale_m must be a finite number > 0, not " +
                    numberText(unit_scale_m));
  }
  requireWithinBounds(path);
  MshReport own;
  return memoryFor<MeshError>("reading mesh file '" + path + "'", [&] {
    try {
      requireFileSize(path, limits);
    } catch (const MeshError& error) {
      throw MeshError("mesh file '" + path + "': " + error.what());
    }
    MshReader reader(path, unit_scale_m);
    reader.read();
    return reader.used(report ? *report : own);
  });
}

}  // namespace viscera
