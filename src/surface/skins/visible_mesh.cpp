// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/surface/visible_mesh.h"

#include <algorithm>
#include <cassert>
#include <cstring>

#include "math/out_file.h"

namespace viscera {

namespace {

/// Bytes of a file, little-endian on every machine.
class Bytes {
 public:
  void add(uint8_t value) { text_.push_back(static_cast<char>(value)); }
  void add(uint32_t value) {
    for (int shift = 0; shift < 32; shift += 8) add(static_cast<uint8_t>(value >> shift));
  }
  void add(float value) {
    uint32_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    add(bits);
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

std::string header(const VisibleMesh& mesh) {
  const VisibleTopology& topology = *mesh.topology;
  std::string out = "ply\nformat binary_little_endian 1.0\ncomment metres\n";
  for (size_t b = 0; b < topology.bodies.size(); ++b) {
    std::string name = topology.bodies[b].name;
    std::replace(name.begin(), name.end(), '\n', ' ');
    out += "comment body " + std::to_string(b) + ' ' + name + '\n';
  }
  out += "element vertex " + std::to_string(mesh.vertices()) + '\n';
  for (const char* property : {"x", "y", "z", "nx", "ny", "nz"}) {
    out += std::string("property float ") + property + '\n';
  }
  if (!mesh.colors.empty()) out += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  out += "element face " + std::to_string(topology.triangleCount()) + '\n';
  return out + "property list uchar uint vertex_indices\nproperty uchar body\nproperty uchar kind\nend_header\n";
}

void addVertices(const VisibleMesh& mesh, Bytes& out) {
  for (size_t v = 0; v < mesh.vertices(); ++v) {
    const Vector3f normal = mesh.normal(v);
    for (size_t axis = 0; axis < 3; ++axis) out.add(mesh.positions_m[3 * v + axis]);
    for (int axis = 0; axis < 3; ++axis) out.add(normal[axis]);
    for (int shift = 0; shift < 24 && !mesh.colors.empty(); shift += 8)
      out.add(static_cast<uint8_t>(mesh.colors[v] >> shift));
  }
}

void addFaces(const VisibleTopology& topology, Bytes& out) {
  for (const VisiblePatch& patch : topology.patches) {
    for (size_t t = patch.first; t < patch.first + patch.count; ++t) {
      out.add(uint8_t{3});
      for (size_t i = 0; i < 3; ++i) out.add(topology.triangles[3 * t + i]);
      out.add(static_cast<uint8_t>(patch.body));
      out.add(static_cast<uint8_t>(patch.kind));
    }
  }
}

}  // namespace

Vector3d woundColor(const Vector3d& skin) {
  static const Vector3d kLeft(0.80, 0.50, 0.46);  // of each primary in wet muscle
  return skin.cwiseProduct(kLeft);
}

const VisiblePatch& VisibleTopology::patchOf(size_t triangle) const {
  assert(triangle < triangleCount());
  const auto behind =
      std::upper_bound(patches.begin(), patches.end(), triangle,
                       [](size_t t, const VisiblePatch& patch) { return t < patch.first + patch.count; });
  return *behind;
}

Vector3f VisibleMesh::normal(size_t vertex) const {
  const Vector3f rounded = unpackNormal(normals[vertex]);
  const float length = rounded.norm();
  return length > 0 ? Vector3f(rounded / length) : rounded;
}

void writePly(const VisibleMesh& mesh, const std::string& path) {
  assert(mesh.topology && mesh.positions_m.size() == 3 * mesh.vertices());
  Bytes bytes;
  addVertices(mesh, bytes);
  addFaces(*mesh.topology, bytes);
  writeFile(path, FileKind::kPly, header(mesh) + bytes.text());
}

}  // namespace viscera
