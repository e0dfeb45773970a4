// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/files/msh_reader.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <unordered_map>

#include "math/number_text.h"
#include "model/shape/files/import_limits.h"
#include "model/shape/files/msh_elements.h"
#include "model/shape/files/msh_numbers.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

struct Element {
  const MshType* type;
  int64_t group;  ///< physical group; 0: none
  std::vector<uint32_t> nodes;
  bool inside_out;
};

class MshReader {
 public:
  MshReader(const std::string& path, double unit_scale_m) : in_(path), unit_scale_m_(unit_scale_m) {}

  void read() {
    while (!in_.isAtEnd()) {
      const std::string section = in_.word();
      if (section[0] != '$' || section.rfind("$End", 0) == 0)
        in_.fail("found '" + section + "' where a section should start");
      readSection(section.substr(1));
    }
    if (positions_m.empty()) in_.fail("the file has no $Nodes");
    if (elements.empty())
      in_.fail("the file has no tetrahedron, hexahedron, prism or pyramid; it has only" + passedOver());
  }

  std::string passedOver() const {
    std::string out;
    for (const auto& [name, count] : passed_over_) out += " " + std::to_string(count) + " " + name;
    return out.empty() ? " no elements" : out;
  }
  std::string note() const {
    std::map<std::string, size_t> read;
    for (const Element& element : elements) ++read[element.type->name];
    TextOut out;
    out << "MSH " << version_ << ":";
    for (const auto& [name, count] : read) out << " " << count << " " << name;
    out << "; ignored:" << passedOver();
    if (volumes_in_two_ > 0)
      out << "; " << volumes_in_two_ << " volumes belong to several physical groups; the first group is used";
    return out.str();
  }
  std::string nameOf(int64_t group) const {
    const auto named = names_.find(group);
    return named != names_.end() ? named->second : group == 0 ? "part" : std::to_string(group);
  }

  std::vector<Vector3d> positions_m;
  std::vector<uint64_t> tags;  ///< [positions]
  std::vector<Element> elements;

 private:
  void readSection(const std::string& section) {
    const bool has_format = version_ != 0;
    if (section == "MeshFormat") {
      readFormat();
    } else if (section == "NOD") {
      version_ = 1;
      readNodes();
    } else if (!has_format) {
      in_.fail("a Gmsh file must start with $MeshFormat or $NOD");
    } else if (section == "PhysicalNames") {
      readNames();
    } else if (section == "PartitionedEntities") {
      in_.fail("partitioned meshes are not supported; save it without partitions");
    } else if (section == "Entities") {
      readEntities();
    } else if (section == "Nodes") {
      version_ < 4 ? readNodes() : readNodeBlocks();
    } else if (section == "ELM" || section == "Elements") {
      version_ < 2 ? readElements1() : version_ < 4 ? readElements2() : readElementBlocks();
    } else {
      return in_.pass("$End" + section);
    }
    in_.setBinary(false);
    if (!read_.insert(section).second) in_.fail("a second $" + section);
    const std::string end = (version_ == 1 ? "$END" : "$End") + section, found = in_.word();
    if (found != end)
      in_.fail("found '" + found + "' instead of " + end + ": the counts in $" + section + " do not match");
  }

  void readFormat() {
    version_ = in_.number();
    const bool is_known = (version_ >= 2 && version_ < 3) || version_ == 4 || version_ == 4.1;
    if (!is_known) {
      in_.fail("version " + numberText(version_) +
               " is not supported; accepted: 1, 2 to 2.2, 4 and 4.1 (gmsh FILE -save -format msh41)");
    }
    is_binary_ = in_.whole(4) == 1;
    if (in_.whole(4) != 8) in_.fail("the data size of $MeshFormat is not 8 bytes");
    in_.setBinary(is_binary_);
    if (is_binary_ && in_.whole(4) != 1)
      in_.fail("big-endian files are not supported; save it as ASCII (gmsh without -bin)");
  }

  void readNames() {
    for (uint64_t left = in_.count(4); left > 0; --left) {
      const int64_t dimension = in_.whole(4), group = in_.whole(4);
      const std::string rest = in_.line();
      const size_t first = rest.find('"'), last = rest.rfind('"');
      if (first == last) in_.fail("a name in quotes must follow its number");
      if (dimension == 3) names_[group] = rest.substr(first + 1, last - first - 1);
    }
  }

  void readEntities() {
    in_.setBinary(is_binary_);
    std::array<uint64_t, 4> counts{};
    for (uint64_t& count : counts) count = in_.count(8);
    for (size_t dimension = 0; dimension < 4; ++dimension)
      for (uint64_t left = counts[dimension]; left > 0; --left) readEntity(dimension);
  }
  void readEntity(size_t dimension) {
    const int64_t entity = in_.whole(4);
    const int numbers = dimension == 0 && version_ > 4 ? 3 : 6;  // position, or bounding box
    for (int i = 0; i < numbers; ++i) in_.number();
    const uint64_t groups = in_.count(8);
    for (uint64_t g = 0; g < groups; ++g) {
      const int64_t group = std::abs(in_.whole(4));
      if (dimension == 3 && g == 0) group_of_volume_[entity] = group;
    }
    if (dimension == 3 && groups > 1) ++volumes_in_two_;
    if (dimension == 0) return;
    for (uint64_t left = in_.count(8); left > 0; --left) in_.whole(4);
  }

  void readNodes() {
    uint64_t left = in_.count(8);
    for (in_.setBinary(is_binary_); left > 0; --left) {
      const uint64_t tag = in_.count(4);
      addNode(tag, 0);
    }
  }
  void readNodeBlocks() {
    in_.setBinary(is_binary_);
    const auto [blocks, nodes] = readCounts();
    for (uint64_t b = 0; b < blocks; ++b) {
      const auto [dimension, entity] = readEntityOf();
      const int64_t parameters = in_.whole(4) != 0 ? dimension : 0;
      const uint64_t count = in_.count(8);
      std::vector<uint64_t> of_block;
      for (uint64_t n = 0; version_ > 4 && n < count; ++n) of_block.push_back(in_.count(8));
      for (uint64_t n = 0; n < count; ++n) {
        const uint64_t tag = version_ > 4 ? of_block[n] : in_.count(4);
        addNode(tag, parameters);
      }
    }
    requireCount("nodes", nodes, positions_m.size());
  }
  void addNode(uint64_t tag, int64_t parameters) {
    const Vector3d file{in_.number(), in_.number(), in_.number()};  // braces evaluate in order
    for (; parameters > 0; --parameters) in_.number();
    const Vector3d at_m = unit_scale_m_ * file;
    if (!at_m.cast<float>().allFinite()) in_.fail("node " + std::to_string(tag) + " is not finite in metres");
    if (!node_of_tag_.try_emplace(tag, static_cast<uint32_t>(tags.size())).second)
      in_.fail("node " + std::to_string(tag) + " is defined twice");
    tags.push_back(tag);
    positions_m.push_back(at_m);
  }

  /// Returns the number of blocks, and the number of entries in them.
  std::pair<uint64_t, uint64_t> readCounts() {
    const uint64_t blocks = in_.count(8), count = in_.count(8);
    for (int i = 0; version_ > 4 && i < 2; ++i) in_.count(8);  // smallest and largest number
    return {blocks, count};
  }
  /// Returns dimension and number of the entity of a block.
  std::pair<int64_t, int64_t> readEntityOf() {
    const int64_t first = in_.whole(4), second = in_.whole(4);
    return version_ > 4 ? std::pair(first, second) : std::pair(second, first);
  }

  void readElements1() {
    for (uint64_t left = in_.count(4); left > 0; --left) {
      in_.count(4);
      const MshType& type = readType();
      const int64_t group = std::abs(in_.whole(4));
      in_.whole(4);
      if (in_.count(4) != type.nodes) in_.fail("the number of nodes does not match the element's type");
      addElement(type, group, 4);
    }
  }
  void readElements2() {
    uint64_t left = in_.count(4);
    in_.setBinary(is_binary_);
    while (left > 0) {
      if (!is_binary_) in_.count(4);
      const MshType& type = readType();
      const uint64_t block = is_binary_ ? in_.count(4) : 1, marks = in_.count(4);
      if (block > left) in_.fail("more elements than $Elements announces");
      for (uint64_t n = 0; n < block; ++n) {
        if (is_binary_) in_.count(4);
        int64_t group = 0;
        for (uint64_t m = 0; m < marks; ++m) {
          const int64_t mark = in_.whole(4);
          if (m == 0) group = std::abs(mark);
        }
        addElement(type, group, 4);
      }
      left -= block;
    }
  }
  void readElementBlocks() {
    in_.setBinary(is_binary_);
    const auto [blocks, count] = readCounts();
    uint64_t read = 0;
    for (uint64_t b = 0; b < blocks; ++b) {
      const auto [dimension, entity] = readEntityOf();
      const MshType& type = readType();
      const auto group = group_of_volume_.find(dimension == 3 ? entity : 0);
      const size_t bytes = version_ > 4 ? 8 : 4;
      for (uint64_t left = in_.count(8); left > 0; --left, ++read) {
        in_.count(bytes);
        addElement(type, dimension == 3 && group != group_of_volume_.end() ? group->second : 0, bytes);
      }
    }
    requireCount("elements", count, read);
  }

  const MshType& readType() {
    const int64_t number = in_.whole(4);
    const MshType* const type = mshType(number);
    if (type == nullptr)
      in_.fail("elements of type " + std::to_string(number) +
               " are not supported; accepted: types of first and second order");
    return *type;
  }
  void addElement(const MshType& type, int64_t group, size_t bytes) {
    Element element{&type, group, {}, false};
    for (size_t n = 0; n < type.nodes; ++n) {
      const uint64_t tag = in_.count(bytes);
      const auto node = node_of_tag_.find(tag);
      if (node == node_of_tag_.end()) in_.fail("node " + std::to_string(tag) + " does not exist");
      element.nodes.push_back(node->second);
    }
    if (type.dimension < 3) {
      ++passed_over_[type.name];
      return;
    }
    element.inside_out = volumeOf(element) < 0;
    elements.push_back(std::move(element));
  }

  double volumeOf(const Element& element) const {
    constexpr double kFlat = 1e-12;  // volume over the cube of the longest distance: rounding of double precision
    const Vector3d first = positions_m[element.nodes[0]];
    double longest_m = 0, volume_m3 = 0;
    for (const uint32_t n : element.nodes) longest_m = std::max(longest_m, (positions_m[n] - first).norm());
    std::vector<std::array<uint32_t, 3>> triangles;
    for (size_t f = 0; f < element.type->faces.size(); ++f) appendFace(*element.type, f, element.nodes, triangles);
    for (const auto& t : triangles) {
      const Vector3d a = positions_m[t[0]] - first, b = positions_m[t[1]] - first;
      volume_m3 += a.cross(b).dot(positions_m[t[2]] - first) / 6;
    }
    if (!(std::abs(volume_m3) > kFlat * longest_m * longest_m * longest_m)) in_.fail("the element is flat");
    return volume_m3;
  }

  void requireCount(const std::string& what, uint64_t announced, uint64_t read) const {
    if (announced != read)
      in_.fail(std::to_string(announced) + " " + what + " announced, " + std::to_string(read) + " found");
  }

  MshNumbers in_;
  double unit_scale_m_;
  double version_ = 0;  ///< 0: not known yet
  bool is_binary_ = false;
  std::unordered_map<uint64_t, uint32_t> node_of_tag_;
  std::map<int64_t, std::string> names_;
  std::map<int64_t, int64_t> group_of_volume_;
  std::map<std::string, size_t> passed_over_;
  size_t volumes_in_two_ = 0;
  std::set<std::string> read_;  ///< sections that were read
};

/// Face of an element, in a form that its neighbour finds.
struct Face {
  std::array<uint32_t, 4> key;  ///< its corners, ascending
  uint32_t next;                ///< corner after the lowest one, seen from outside
  uint32_t element, face;
};

Face faceOf(const std::vector<Element>& elements, size_t e, size_t f) {
  const Element& element = elements[e];
  const std::vector<size_t>& corners = element.type->faces[f];
  Face out{{UINT32_MAX, UINT32_MAX, UINT32_MAX, UINT32_MAX}, 0, static_cast<uint32_t>(e), static_cast<uint32_t>(f)};
  for (size_t c = 0; c < corners.size(); ++c) out.key[c] = element.nodes[corners[c]];
  const auto first = static_cast<size_t>(std::min_element(out.key.begin(), out.key.end()) - out.key.begin());
  out.next = out.key[(first + (element.inside_out ? corners.size() - 1 : 1)) % corners.size()];
  std::sort(out.key.begin(), out.key.end());
  return out;
}

/// Returns the faces of all elements, equal ones next to each other.
std::vector<Face> sortedFaces(const std::vector<Element>& elements) {
  std::vector<Face> faces;
  for (size_t e = 0; e < elements.size(); ++e)
    for (size_t f = 0; f < elements[e].type->faces.size(); ++f) faces.push_back(faceOf(elements, e, f));
  std::sort(faces.begin(), faces.end(),
            [](const Face& a, const Face& b) { return a.key != b.key ? a.key < b.key : a.element < b.element; });
  return faces;
}

/// Returns the mesh of the groups, still without triangles. @param parts  gets the number of each group's part
TriangleMesh partsOf(const MshReader& reader, std::map<int64_t, uint16_t>& parts) {
  TriangleMesh mesh;
  for (const Vector3d& at_m : reader.positions_m) mesh.positions_m.push_back(at_m.cast<float>());
  for (const Element& element : reader.elements) parts[element.group] = 0;
  if (parts.size() >= UINT16_MAX) throw MeshError("has more than " + std::to_string(UINT16_MAX - 1) + " groups");
  std::set<std::string> known;
  for (auto& [group, part] : parts) {
    part = static_cast<uint16_t>(mesh.part_names.size());
    std::string name = reader.nameOf(group);
    for (int n = 2; !known.insert(name).second; ++n) name = reader.nameOf(group) + "_" + std::to_string(n);
    mesh.part_names.push_back(name);
  }
  return mesh;
}

}  // namespace

bool isMsh(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension == ".msh";
}

TriangleMesh readMsh(const std::string& path, double unit_scale_m, const ImportLimits& limits, std::string& note) {
  MshReader reader(path, unit_scale_m);
  reader.read();
  note = reader.note();
  std::map<int64_t, uint16_t> parts;
  TriangleMesh mesh = partsOf(reader, parts);
  const std::vector<Element>& elements = reader.elements;
  const auto add = [&](const Face& face) {
    const Element& element = elements[face.element];
    const size_t before = mesh.triangles.size();
    appendFace(*element.type, face.face, element.nodes, mesh.triangles);
    for (size_t t = before; element.inside_out && t < mesh.triangles.size(); ++t)
      std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    mesh.parts.resize(mesh.triangles.size(), parts.at(element.group));
  };
  const std::vector<Face> faces = sortedFaces(elements);
  for (size_t i = 0, end = 0; i < faces.size(); i = end) {
    while (end < faces.size() && faces[end].key == faces[i].key) ++end;
    if (end - i > 2 || (end - i == 2 && faces[i].next == faces[i + 1].next)) {
      TextOut out;
      for (size_t c = 0; c < 3; ++c) out << (c > 0 ? ", " : "") << reader.tags[faces[i].key[c]];
      throw MeshError("elements overlap at the face of nodes " + out.str() +
                      "; each element may belong to only one physical group");
    }
    if (end - i == 2 && elements[faces[i].element].group == elements[faces[i + 1].element].group) continue;
    for (size_t f = i; f < end; ++f) add(faces[f]);
    requireAtMost(static_cast<double>(mesh.triangles.size()), limits.max_triangles, "triangles", "max_triangles");
  }
  return mesh;
}

}  // namespace viscera
