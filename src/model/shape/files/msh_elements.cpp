// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/files/msh_elements.h"

#include <algorithm>
#include <map>

namespace viscera {
namespace {

using Faces = std::vector<std::vector<size_t>>;
using Edges = std::vector<std::array<size_t, 2>>;

std::map<int64_t, MshType> allTypes() {
  const Faces tetrahedron = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {3, 1, 2}};
  const Faces hexahedron = {{0, 3, 2, 1}, {0, 1, 5, 4}, {0, 4, 7, 3}, {1, 2, 6, 5}, {2, 3, 7, 6}, {4, 5, 6, 7}};
  const Faces prism = {{0, 1, 4, 3}, {0, 3, 5, 2}, {1, 2, 5, 4}, {0, 2, 1}, {3, 4, 5}};
  const Faces pyramid = {{0, 3, 2, 1}, {0, 1, 4}, {3, 0, 4}, {1, 2, 4}, {2, 3, 4}};
  const Edges of_tetrahedron = {{0, 1}, {1, 2}, {2, 0}, {3, 0}, {3, 2}, {3, 1}};
  const Edges of_hexahedron = {{0, 1}, {0, 3}, {0, 4}, {1, 2}, {1, 5}, {2, 3},
                               {2, 6}, {3, 7}, {4, 5}, {4, 7}, {5, 6}, {6, 7}};
  const Edges of_prism = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 4}, {2, 5}, {3, 4}, {3, 5}, {4, 5}};
  const Edges of_pyramid = {{0, 1}, {0, 3}, {0, 4}, {1, 2}, {1, 4}, {2, 3}, {2, 4}, {3, 4}};
  return {{15, {"points", 1, 1, 0, {}, {}}},
          {1, {"lines", 2, 2, 1, {}, {}}},
          {8, {"lines", 3, 2, 1, {}, {}}},
          {2, {"triangles", 3, 3, 2, {}, {}}},
          {9, {"triangles", 6, 3, 2, {}, {}}},
          {3, {"quadrangles", 4, 4, 2, {}, {}}},
          {10, {"quadrangles", 9, 4, 2, {}, {}}},
          {16, {"quadrangles", 8, 4, 2, {}, {}}},
          {4, {"tetrahedra", 4, 4, 3, tetrahedron, {}}},
          {11, {"tetrahedra", 10, 4, 3, tetrahedron, of_tetrahedron}},
          {5, {"hexahedra", 8, 8, 3, hexahedron, {}}},
          {17, {"hexahedra", 20, 8, 3, hexahedron, of_hexahedron}},
          {12, {"hexahedra", 27, 8, 3, hexahedron, of_hexahedron}},
          {6, {"prisms", 6, 6, 3, prism, {}}},
          {18, {"prisms", 15, 6, 3, prism, of_prism}},
          {13, {"prisms", 18, 6, 3, prism, of_prism}},
          {7, {"pyramids", 5, 5, 3, pyramid, {}}},
          {19, {"pyramids", 13, 5, 3, pyramid, of_pyramid}},
          {14, {"pyramids", 14, 5, 3, pyramid, of_pyramid}}};
}

/// Appends a triangle, or a quadrangle divided from its lowest node.
void appendPolygon(const std::vector<uint32_t>& ring, std::vector<std::array<uint32_t, 3>>& triangles) {
  const auto first = static_cast<size_t>(std::min_element(ring.begin(), ring.end()) - ring.begin());
  const auto at = [&](size_t i) { return ring[(first + i) % ring.size()]; };
  for (size_t i = 1; i + 1 < ring.size(); ++i) triangles.push_back({at(0), at(i), at(i + 1)});
}

}  // namespace

const MshType* mshType(int64_t number) {
  static const std::map<int64_t, MshType> types = allTypes();
  const auto found = types.find(number);
  return found == types.end() ? nullptr : &found->second;
}

void appendFace(const MshType& type, size_t face, const std::vector<uint32_t>& nodes,
                std::vector<std::array<uint32_t, 3>>& triangles) {
  const std::vector<size_t>& corners = type.faces[face];
  std::vector<uint32_t> ring;
  if (type.edges.empty()) {
    for (const size_t corner : corners) ring.push_back(nodes[corner]);
    return appendPolygon(ring, triangles);
  }
  const auto between = [&](size_t a, size_t b) {
    const auto is_it = [&](const std::array<size_t, 2>& e) { return std::minmax(e[0], e[1]) == std::minmax(a, b); };
    return nodes[type.corners +
                 static_cast<size_t>(std::find_if(type.edges.begin(), type.edges.end(), is_it) - type.edges.begin())];
  };
  for (size_t i = 0; i < corners.size(); ++i) ring.push_back(between(corners[i], corners[(i + 1) % corners.size()]));
  for (size_t i = 0; i < corners.size(); ++i)
    triangles.push_back({ring[(i + corners.size() - 1) % corners.size()], nodes[corners[i]], ring[i]});
  const size_t middle = type.corners + type.edges.size() + face;  // quadrangles are the first faces of a type
  if (corners.size() == 3 || middle >= nodes.size()) return appendPolygon(ring, triangles);
  for (size_t i = 0; i < ring.size(); ++i) triangles.push_back({ring[i], ring[(i + 1) % ring.size()], nodes[middle]});
}

}  // namespace viscera
