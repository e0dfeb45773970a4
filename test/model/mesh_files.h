// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "viscera/model/shape/triangle_mesh.h"

namespace viscera::test {

// Writers of small mesh files, independent of the library that reads them.

inline void writeFile(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

template <typename T>
std::string bytesOf(const T& value) {
  return std::string(reinterpret_cast<const char*>(&value), sizeof value);
}

inline std::string bytesOf(const Vector3f& v) {
  return bytesOf(v.x()) + bytesOf(v.y()) + bytesOf(v.z());
}

inline std::string objText(const TriangleMesh& mesh) {
  std::ostringstream out;
  out.precision(9);
  for (const Vector3f& p : mesh.positions_m) out << "v " << p.transpose() << '\n';
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (t == 0 || mesh.parts[t] != mesh.parts[t - 1]) out << "o " << mesh.part_names[mesh.parts[t]] << '\n';
    out << "f " << mesh.triangles[t][0] + 1 << ' ' << mesh.triangles[t][1] + 1 << ' ' << mesh.triangles[t][2] + 1
        << '\n';
  }
  return out.str();
}

inline std::string asciiStl(const TriangleMesh& mesh) {
  std::ostringstream out;
  out.precision(9);
  out << "solid part\n";
  for (const auto& t : mesh.triangles) {
    out << "facet normal 0 0 0\nouter loop\n";
    for (const uint32_t v : t) out << "vertex " << mesh.positions_m[v].transpose() << '\n';
    out << "endloop\nendfacet\n";
  }
  out << "endsolid part\n";
  return out.str();
}

inline std::string binaryStl(const TriangleMesh& mesh) {
  std::string out(80, ' ');
  out += bytesOf(static_cast<uint32_t>(mesh.triangles.size()));
  for (const auto& t : mesh.triangles) {
    out += bytesOf(Vector3f(0, 0, 0));
    for (const uint32_t v : t) out += bytesOf(mesh.positions_m[v]);
    out += bytesOf(uint16_t{0});
  }
  return out;
}

inline std::string plyText(const TriangleMesh& mesh) {
  std::ostringstream out;
  out.precision(9);
  out << "ply\nformat ascii 1.0\nelement vertex " << mesh.positions_m.size()
      << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << mesh.triangles.size()
      << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vector3f& p : mesh.positions_m) out << p.transpose() << '\n';
  for (const auto& t : mesh.triangles) out << "3 " << t[0] << ' ' << t[1] << ' ' << t[2] << '\n';
  return out.str();
}

inline std::string binaryPly(const TriangleMesh& mesh) {
  std::ostringstream header;
  header << "ply\nformat binary_little_endian 1.0\nelement vertex " << mesh.positions_m.size()
         << "\nproperty float x\nproperty float y\nproperty float z\nelement face " << mesh.triangles.size()
         << "\nproperty list uchar int vertex_indices\nend_header\n";
  std::string out = header.str();
  for (const Vector3f& p : mesh.positions_m) out += bytesOf(p);
  for (const auto& t : mesh.triangles) {
    out += bytesOf(uint8_t{3});
    for (const uint32_t v : t) out += bytesOf(v);
  }
  return out;
}

/// Node of a GLB scene: a name and the rest of its JSON, such as "mesh":0 or a matrix.
struct GlbNode {
  std::string name, json;
};

/// Returns a GLB file with one mesh of triangles, a mesh of two stray points, a mesh of one stray line, and the given
/// nodes; they can refer to meshes 0, 1 and 2.
inline std::string glb(const TriangleMesh& mesh, const std::vector<GlbNode>& nodes) {
  std::string binary;
  for (const Vector3f& p : mesh.positions_m) binary += bytesOf(p);
  const size_t vertex_bytes = binary.size();
  for (const auto& t : mesh.triangles) {
    for (const uint32_t v : t) binary += bytesOf(v);
  }
  std::ostringstream json;
  json << R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[)";
  for (size_t i = 0; i < nodes.size(); ++i) json << (i ? "," : "") << i;
  json << "]}],\"nodes\":[";
  for (size_t i = 0; i < nodes.size(); ++i) {
    json << (i ? "," : "") << "{\"name\":\"" << nodes[i].name << "\"," << nodes[i].json << "}";
  }
  json << R"(],"meshes":[{"name":"shape","primitives":[{"attributes":{"POSITION":0},"indices":1}]},)"
       << R"({"name":"dots","primitives":[{"attributes":{"POSITION":2},"mode":0}]},)"
       << R"({"name":"dash","primitives":[{"attributes":{"POSITION":2},"mode":1}]}],)"
       << R"("buffers":[{"byteLength":)" << binary.size() << R"(}],"bufferViews":[{"buffer":0,"byteLength":)"
       << vertex_bytes << R"(},{"buffer":0,"byteOffset":)" << vertex_bytes << R"(,"byteLength":)"
       << binary.size() - vertex_bytes
       << R"(}],"accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":)" << mesh.positions_m.size()
       << R"(},{"bufferView":1,"componentType":5125,"type":"SCALAR","count":)" << 3 * mesh.triangles.size()
       << R"(},{"bufferView":0,"componentType":5126,"type":"VEC3","count":2}]})";
  std::string text = json.str();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  return "glTF" + bytesOf(uint32_t{2}) + bytesOf(static_cast<uint32_t>(28 + text.size() + binary.size())) +
         bytesOf(static_cast<uint32_t>(text.size())) + "JSON" + text + bytesOf(static_cast<uint32_t>(binary.size())) +
         std::string("BIN\0", 4) + binary;
}

}  // namespace viscera::test
