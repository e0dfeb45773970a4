// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <nlohmann/json.hpp>

#include "export/writers.h"

namespace viscera {

namespace {

using Json = nlohmann::ordered_json;

// Constants of the format.
constexpr uint32_t kMagic = 0x46546C67, kVersion = 2, kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;
constexpr int kFloat = 5126, kUint = 5125, kVertices = 34962, kIndices = 34963;

void put(OutFile& file, uint32_t value) {
  file.write(&value, sizeof value);
}

/// Buffer views and accessors of one buffer.
class Buffers {
 public:
  template <class T>
  int add(const std::vector<T>& values, int type, int target, int components) {
    const size_t bytes = values.size() * sizeof(T);
    views.push_back({{"buffer", 0}, {"byteOffset", binary.size()}, {"byteLength", bytes}, {"target", target}});
    accessors.push_back({{"bufferView", views.size() - 1},
                         {"componentType", type},
                         {"count", values.size() / static_cast<size_t>(components)},
                         {"type", components == 3 ? "VEC3" : "SCALAR"}});
    binary.append(reinterpret_cast<const char*>(values.data()), bytes);
    return static_cast<int>(accessors.size()) - 1;
  }
  Json views = Json::array(), accessors = Json::array();
  std::string binary;
};

// From sRGB to linear, approximately.
double linear(double c) {
  return std::pow(c, 2.2);
}

Json materialOf(const Vector3d& color) {
  return {{"pbrMetallicRoughness",
           {{"baseColorFactor", {linear(color.x()), linear(color.y()), linear(color.z()), 1.0}},
            {"metallicFactor", 0.0},
            {"roughnessFactor", 0.4}}},
          {"doubleSided", true}};
}

std::vector<float> unitNormals(const VisibleMesh& skin) {
  std::vector<float> out;
  for (size_t v = 0; v < skin.vertices(); ++v) {
    const Vector3f n = skin.normal(v);
    const Vector3f unit = n.norm() > 0 ? n.normalized() : Vector3f(0, 0, 1);
    out.insert(out.end(), {unit.x(), unit.y(), unit.z()});
  }
  return out;
}

}  // namespace

void writeGlb(const VisibleMesh& skin, const std::string& path) {
  Buffers buffers;
  const std::vector<float> normals = unitNormals(skin);
  const int positions = buffers.add(skin.positions_m, kFloat, kVertices, 3);
  Vector3f low = Vector3f::Constant(HUGE_VALF), high = -low;
  for (size_t v = 0; v < skin.vertices(); ++v) {
    low = low.cwiseMin(skin.position_m(v));
    high = high.cwiseMax(skin.position_m(v));
  }
  buffers.accessors[0]["min"] = {low.x(), low.y(), low.z()};
  buffers.accessors[0]["max"] = {high.x(), high.y(), high.z()};
  const int directions = buffers.add(normals, kFloat, kVertices, 3);
  Json attributes = {{"POSITION", positions}, {"NORMAL", directions}};
  if (!skin.colors.empty()) {
    std::vector<float> colors;
    for (const uint32_t color : skin.colors)
      for (const int shift : {0, 8, 16}) colors.push_back(static_cast<float>(linear((color >> shift & 255U) / 255.0)));
    attributes["COLOR_0"] = buffers.add(colors, kFloat, kVertices, 3);
  }
  Json primitives = Json::array(), materials = Json::array();
  for (const VisiblePatch& patch : skin.topology->patches) {
    if (patch.count == 0) continue;
    const auto first = skin.topology->triangles.begin() + static_cast<std::ptrdiff_t>(3 * patch.first);
    const std::vector<uint32_t> corners(first, first + static_cast<std::ptrdiff_t>(3 * patch.count));
    const Vector3d& body = skin.topology->bodies[patch.body].color;
    const Vector3d color = patch.kind == SurfaceKind::kWound ? woundColor(body) : body;
    materials.push_back(
        materialOf(skin.colors.empty() ? color : Vector3d::Ones()));  // colours of vertices are multiplied by it
    primitives.push_back({{"attributes", attributes},
                          {"indices", buffers.add(corners, kUint, kIndices, 1)},
                          {"material", materials.size() - 1}});
  }
  const double half = std::sqrt(0.5);  // z up becomes y up
  Json json = {{"asset", {{"version", "2.0"}, {"generator", "viscera"}}},
               {"scene", 0},
               {"scenes", {{{"nodes", {0}}}}},
               {"nodes", {{{"mesh", 0}, {"rotation", {-half, 0.0, 0.0, half}}}}},
               {"meshes", {{{"primitives", primitives}}}},
               {"materials", materials},
               {"buffers", {{{"byteLength", buffers.binary.size()}}}},
               {"bufferViews", buffers.views},
               {"accessors", buffers.accessors}};
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  OutFile file(path, FileKind::kGlb);
  put(file, kMagic);
  put(file, kVersion);
  put(file, static_cast<uint32_t>(12 + 8 + text.size() + 8 + buffers.binary.size()));
  put(file, static_cast<uint32_t>(text.size()));
  put(file, kJsonChunk);
  file.write(text);
  put(file, static_cast<uint32_t>(buffers.binary.size()));  // of words: a multiple of 4
  put(file, kBinaryChunk);
  file.write(buffers.binary.data(), buffers.binary.size());
  file.keep();
}

}  // namespace viscera
