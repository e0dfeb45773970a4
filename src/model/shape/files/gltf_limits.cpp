// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/files/gltf_limits.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <numeric>

#include "math/number_text.h"
#include "model/shape/files/gltf_tree.h"
#include "model/shape/files/import_limits.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

constexpr const char* kGltfMagic = "glTF";
constexpr double kGltfBytesPerMb = 1e6;

uint32_t wordAt(const std::string& bytes, size_t at) {
  uint32_t word = 0;
  if (at + sizeof word > bytes.size()) throw MeshError("is truncated: it ends within the header of a chunk");
  std::memcpy(&word, bytes.data() + at, sizeof word);
  return word;
}

/// Splits a GLB file; all of its chunks must be complete.
GltfText splitGlb(const std::string& bytes) {
  constexpr size_t kHeader = 12, kChunkHeader = 8;
  constexpr uint32_t kJson = 0x4e4f534a;  // "JSON"
  const uint32_t version = wordAt(bytes, 4);
  if (version != 2) throw MeshError("is GLB of version " + std::to_string(version) + "; only version 2 is supported");
  if (wordAt(bytes, kHeader + 4) != kJson) throw MeshError("is corrupt: its first chunk is not JSON");
  const size_t json_bytes = wordAt(bytes, kHeader);
  for (size_t at = kHeader; at < bytes.size();) {
    const size_t end = at + kChunkHeader + wordAt(bytes, at);
    if (end > bytes.size()) {
      throw MeshError("is truncated: a chunk ends at byte " + std::to_string(end) + ", the file at byte " +
                      std::to_string(bytes.size()));
    }
    at = end;
    if (bytes.size() - at < kChunkHeader) break;  // padding
  }
  return {bytes.substr(kHeader + kChunkHeader, json_bytes), bytes.substr(kHeader + kChunkHeader + json_bytes), true};
}

std::string jsonOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  TextOut all;
  all << file.rdbuf();
  std::string text = splitGltf(all.str()).json;
  // Names in encodings other than UTF-8 are no error here.
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c >= 0x80; }, '?');
  return text;
}

GltfTree treeOf(const std::string& path) {
  GltfTree tree;
  GltfTreeReader reader(tree);
  if (!nlohmann::json::sax_parse(jsonOf(path), &reader)) throw MeshError("is corrupt: " + reader.fault);
  if (tree.version.empty() || tree.version[0] != '2') {
    throw MeshError("is glTF of version '" + tree.version + "'; only version 2 is supported");
  }
  return tree;
}

/// Returns the nodes with parents before children by Kahn's algorithm, which leaves out cycles.
std::vector<size_t> parentsFirst(const GltfTree& tree) {
  std::vector<size_t> parents(tree.nodes.size(), 0), order;
  for (size_t n = 0; n < tree.nodes.size(); ++n) {
    for (const uint64_t child : tree.nodes[n].children) {
      if (child >= tree.nodes.size()) {
        throw MeshError("is corrupt: node " + std::to_string(n) + " has the child " + std::to_string(child) + " of " +
                        std::to_string(tree.nodes.size()) + " nodes");
      }
      ++parents[child];
    }
  }
  for (size_t n = 0; n < parents.size(); ++n) {
    if (parents[n] == 0) order.push_back(n);
  }
  for (size_t next = 0; next < order.size(); ++next) {
    for (const uint64_t child : tree.nodes[order[next]].children) {
      if (--parents[child] == 0) order.push_back(child);
    }
  }
  if (order.size() == parents.size()) return order;
  const auto stuck = std::find_if(parents.begin(), parents.end(), [](size_t left) { return left > 0; });
  throw MeshError("is corrupt: its nodes form a cycle, node " + std::to_string(stuck - parents.begin()) +
                  " is in it or below it");
}

void requireDepth(const GltfTree& tree, const std::vector<size_t>& order, const ImportLimits& limits) {
  std::vector<int> depth(tree.nodes.size(), 1);
  int deepest = 0;
  for (const size_t n : order) {
    deepest = std::max(deepest, depth[n]);
    for (const uint64_t child : tree.nodes[n].children) depth[child] = std::max(depth[child], depth[n] + 1);
  }
  requireAtMost(deepest, limits.max_depth, "depth of nested nodes", "max_depth");
}

/// Returns the number of instances of each node after shared nodes have been copied. Scenes are added up: a few copies
/// too many of shared nodes do no harm.
std::vector<double> instancesOf(const GltfTree& tree, const std::vector<size_t>& order) {
  std::vector<double> instances(tree.nodes.size(), 0);
  for (const auto& roots : tree.scenes) {
    for (const uint64_t root : roots) {
      if (root < instances.size()) ++instances[root];
    }
  }
  for (const size_t n : order) {
    for (const uint64_t child : tree.nodes[n].children) instances[child] += instances[n];
  }
  return instances;
}

double countOf(const GltfTree& tree, uint64_t accessor) {
  return accessor < tree.accessor_counts.size() ? tree.accessor_counts[accessor] : 0;
}

/// Returns the number of triangles that would take the memory of a mesh: a point or a line takes as much.
double trianglesOf(const GltfTree& tree, const std::vector<GltfTree::Primitive>& mesh) {
  double triangles = 0;
  for (const GltfTree::Primitive& primitive : mesh) {
    double corners = 0;
    for (const uint64_t accessor : primitive.accessors) corners = std::max(corners, countOf(tree, accessor));
    triangles += primitive.mode == GltfTree::kTriangles ? corners / 3 : corners;
    for (const uint64_t accessor : primitive.of_targets) triangles += countOf(tree, accessor) / 3;
  }
  return triangles;
}

void requireTriangles(const GltfTree& tree, const std::vector<double>& instances, const ImportLimits& limits) {
  std::vector<double> of_mesh(tree.meshes.size());
  std::transform(tree.meshes.begin(), tree.meshes.end(), of_mesh.begin(),
                 [&](const auto& mesh) { return trianglesOf(tree, mesh); });
  const double once = std::accumulate(of_mesh.begin(), of_mesh.end(), 0.0);  // all are read, visible or not
  double shown = 0;
  for (size_t n = 0; n < tree.nodes.size(); ++n) {
    for (const uint64_t mesh : tree.nodes[n].meshes) shown += mesh < of_mesh.size() ? instances[n] * of_mesh[mesh] : 0;
  }
  requireAtMost(std::ceil(std::max(once, shown)), limits.max_triangles, "triangles", "max_triangles");
}

/// Returns whether an extension concerns appearance or is read. Any other could change the shape.
bool isReadOrLook(const std::string& extension) {
  constexpr const char* kBegin[] = {
      "KHR_materials_",       "KHR_texture_", "EXT_texture_", "MSFT_texture_",
      "KHR_lights_",          "EXT_lights_",  "KHR_xmp",      "KHR_draco_mesh_compression",
      "KHR_mesh_quantization"};
  return std::any_of(std::begin(kBegin), std::end(kBegin),
                     [&](const char* begin) { return extension.rfind(begin, 0) == 0; });
}

void requireKnownExtensions(const GltfTree& tree) {
  for (const std::string& extension : tree.required) {
    if (isReadOrLook(extension)) continue;
    const bool packed = extension == "EXT_meshopt_compression";
    throw MeshError("requires the extension " + extension + ", which is not supported; write it without" +
                    (packed ? ", for instance with gltfpack without -c" : ""));
  }
}

bool isQuantised(const GltfTree& tree) {
  constexpr uint64_t kFloat = 5126;
  const auto isWhole = [&](uint64_t accessor) {
    const uint64_t type = accessor < tree.component_types.size() ? tree.component_types[accessor] : 0;
    return type != 0 && type != kFloat;
  };
  for (const auto& mesh : tree.meshes)
    for (const GltfTree::Primitive& primitive : mesh)
      if (std::any_of(primitive.reals.begin(), primitive.reals.end(), isWhole)) return true;
  return false;
}

/// Returns the number of listed triangles, with those of strips and fans.
double listedTriangles(const GltfTree& tree) {
  double all = 0;
  for (const auto& mesh : tree.meshes) {
    for (const GltfTree::Primitive& primitive : mesh) {
      double corners = 0;
      for (const uint64_t accessor : primitive.indices.empty() ? primitive.accessors : primitive.indices)
        corners = std::max(corners, countOf(tree, accessor));
      if (primitive.mode == GltfTree::kTriangles) all += std::floor(corners / 3);
      if (primitive.mode > GltfTree::kTriangles) all += std::max(corners - 2, 0.0);
    }
  }
  return all;
}

}  // namespace

GltfText splitGltf(std::string bytes) {
  const bool is_glb = bytes.compare(0, std::strlen(kGltfMagic), kGltfMagic) == 0;
  GltfText out = is_glb ? splitGlb(bytes) : GltfText{std::move(bytes), "", false};
  out.json.resize(std::min(out.json.size(), out.json.find('\0')));  // some writers pad with it, and readers stop there
  return out;
}

bool looksLikeGltf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  char magic[4] = {};
  file.read(magic, sizeof magic);
  if (std::memcmp(magic, kGltfMagic, sizeof magic) == 0) return true;
  file.clear();
  file.seekg(0);
  constexpr unsigned char kByteOrderMark[] = {0xef, 0xbb, 0xbf};
  if (std::memcmp(magic, kByteOrderMark, sizeof kByteOrderMark) == 0) file.seekg(sizeof kByteOrderMark);
  char first = 0;
  return file >> first && first == '{';
}

GltfFacts requireGltfWithin(const std::string& path, const ImportLimits& limits) {
  const GltfTree tree = treeOf(path);
  requireKnownExtensions(tree);
  if (tree.scenes.empty()) throw MeshError("has no scene, so no nodes are shown; export it with a scene");
  const double bytes = std::accumulate(tree.buffer_bytes.begin(), tree.buffer_bytes.end(), 0.0);
  requireAtMost(bytes / kGltfBytesPerMb, limits.max_file_mb, "size of its buffers in MB", "max_file_mb");
  const std::vector<size_t> order = parentsFirst(tree);
  requireDepth(tree, order, limits);
  const std::vector<double> instances = instancesOf(tree, order);
  requireAtMost(std::accumulate(instances.begin(), instances.end(), 0.0), limits.max_instances,
                "instances of nodes, with shared nodes counted each time", "max_instances");
  requireTriangles(tree, instances, limits);
  GltfFacts facts;
  facts.is_quantised = isQuantised(tree);
  facts.triangles = listedTriangles(tree);
  facts.is_draco =
      std::find(tree.required.begin(), tree.required.end(), "KHR_draco_mesh_compression") != tree.required.end();
  return facts;
}

}  // namespace viscera
