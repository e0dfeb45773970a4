// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "math/number_text.h"
#include "model/mesh_files.h"
#include "viscera/math/types.h"

namespace viscera::test {

/// Element of a Gmsh file: its type, its physical group and its nodes from 1.
struct MshElement {
  int type, group;
  std::vector<int> nodes;
};

struct MshMesh {
  std::vector<Vector3d> nodes;
  std::vector<MshElement> elements;
  std::map<int, std::string> names;  ///< names of groups of volumes
};

/// Numbers of a Gmsh file, as text or bytes.
class MshOut {
 public:
  explicit MshOut(bool binary) : binary_(binary) { text_.precision(17); }
  template <class... Numbers>
  MshOut& row(Numbers... numbers) {
    (add(numbers), ...);
    if (!binary_) text_ << '\n';
    return *this;
  }
  void nodes(const std::vector<int>& nodes, bool wide) {
    for (const int n : nodes) wide ? add(static_cast<uint64_t>(n)) : add(n);
    if (!binary_) text_ << '\n';
  }
  template <class Number>
  void add(Number number) {
    if (binary_)
      text_ << bytesOf(number);
    else
      text_ << number << ' ';
  }
  TextOut& text() { return text_; }

 private:
  bool binary_;
  TextOut text_;
};

inline int dimensionOf(const MshElement& element) {
  return element.type == 15 ? 0 : element.type == 1 ? 1 : element.type == 2 ? 2 : 3;
}

inline void writeMsh1(const MshMesh& mesh, MshOut& out) {
  out.text() << "$NOD\n" << mesh.nodes.size() << '\n';
  for (size_t n = 0; n < mesh.nodes.size(); ++n)
    out.row(n + 1, mesh.nodes[n].x(), mesh.nodes[n].y(), mesh.nodes[n].z());
  out.text() << "$ENDNOD\n$ELM\n" << mesh.elements.size() << '\n';
  for (size_t e = 0; e < mesh.elements.size(); ++e) {
    const MshElement& element = mesh.elements[e];
    for (const int number :
         {static_cast<int>(e) + 1, element.type, element.group, 1, static_cast<int>(element.nodes.size())})
      out.add(number);
    out.nodes(element.nodes, false);
  }
  out.text() << "$ENDELM\n";
}

inline void writeMsh2(const MshMesh& mesh, bool binary, MshOut& out) {
  out.text() << "$Nodes\n" << mesh.nodes.size() << '\n';
  for (size_t n = 0; n < mesh.nodes.size(); ++n)
    out.row(static_cast<int>(n) + 1, mesh.nodes[n].x(), mesh.nodes[n].y(), mesh.nodes[n].z());
  out.text() << (binary ? "\n" : "") << "$EndNodes\n$Elements\n" << mesh.elements.size() << '\n';
  for (size_t e = 0; e < mesh.elements.size(); ++e) {
    const MshElement& element = mesh.elements[e];
    const int number = static_cast<int>(e) + 1;
    if (binary)
      out.row(element.type, 1, 2, number);
    else
      for (const int head : {number, element.type, 2}) out.add(head);
    out.add(element.group);
    out.add(1);
    out.nodes(element.nodes, false);
  }
  out.text() << (binary ? "\n" : "") << "$EndElements\n";
}

/// Writes MSH 4. Each group is an entity with ten times its number.
inline void writeMsh4(const MshMesh& mesh, bool is_41, bool binary, MshOut& out) {
  const char* const end = binary ? "\n" : "";
  const auto size = [](size_t number) { return static_cast<uint64_t>(number); };
  std::map<int, std::map<int, std::vector<const MshElement*>>> volumes;  // by group and type
  std::vector<const MshElement*> others;
  size_t blocks = 0;
  for (const MshElement& element : mesh.elements) {
    if (dimensionOf(element) == 3)
      volumes[element.group][element.type].push_back(&element);
    else
      others.push_back(&element);
  }
  for (const auto& [group, types] : volumes) blocks += types.size();
  out.text() << "$Entities\n";
  out.row(size(1), size(0), size(0), size(volumes.size()));
  out.row(5, 0.0, 0.0, 0.0);
  if (!is_41) out.row(0.0, 0.0, 0.0);
  out.row(size(0));
  for (const auto& [group, types] : volumes) {
    out.row(10 * group, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, size(group > 0 ? 1 : 0));
    if (group > 0) out.add(group);
    out.row(size(1), -3);
  }
  out.text() << end << "$EndEntities\n$Nodes\n";
  const size_t count = mesh.nodes.size();
  out.row(size(1), size(count));
  if (is_41) out.row(size(1), size(count));
  is_41 ? out.row(3, 10, 0, size(count)) : out.row(10, 3, 0, size(count));
  for (size_t n = 0; is_41 && n < count; ++n) out.row(size(n + 1));
  for (size_t n = 0; n < count; ++n) {
    if (!is_41) out.add(static_cast<int>(n) + 1);
    out.row(mesh.nodes[n].x(), mesh.nodes[n].y(), mesh.nodes[n].z());
  }
  out.text() << end << "$EndNodes\n$Elements\n";
  out.row(size(blocks + others.size()), size(mesh.elements.size()));
  if (is_41) out.row(size(1), size(mesh.elements.size()));
  size_t number = 0;
  const auto add = [&](int dimension, int entity, const std::vector<const MshElement*>& of) {
    is_41 ? out.row(dimension, entity, of[0]->type, size(of.size()))
          : out.row(entity, dimension, of[0]->type, size(of.size()));
    for (const MshElement* element : of) {
      ++number;
      is_41 ? out.add(size(number)) : out.add(static_cast<int>(number));
      out.nodes(element->nodes, is_41);
    }
  };
  for (const MshElement* other : others) add(dimensionOf(*other), 5, {other});
  for (const auto& [group, types] : volumes)
    for (const auto& [type, of] : types) add(3, 10 * group, of);
  out.text() << end << "$EndElements\n";
}

/// Returns the bytes of a Gmsh file. @param version  1, 2.2, 4 or 4.1
inline std::string mshText(const MshMesh& mesh, double version, bool binary) {
  MshOut out(binary);
  if (version == 1) {
    writeMsh1(mesh, out);
    return out.text().str();
  }
  out.text() << "$MeshFormat\n" << numberText(version) << (binary ? " 1 8\n" + bytesOf(1) + "\n" : " 0 8\n");
  out.text() << "$EndMeshFormat\n$PhysicalNames\n" << mesh.names.size() << '\n';
  for (const auto& [group, name] : mesh.names) out.text() << "3 " << group << " \"" << name << "\"\n";
  out.text() << "$EndPhysicalNames\n";
  version == 2.2 ? writeMsh2(mesh, binary, out) : writeMsh4(mesh, version > 4, binary, out);
  return out.text().str();
}

}  // namespace viscera::test
