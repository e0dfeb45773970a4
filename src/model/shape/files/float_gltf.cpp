// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/files/float_gltf.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "model/shape/files/gltf_file.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

using Json = nlohmann::json;

constexpr const char* kNumbers = "viscera-floats.bin";  ///< name of the file of numbers, in memory only
constexpr int kFloat = 5126;

/// Layout of an accessor's numbers in a buffer.
struct Numbers {
  GltfFile::Items items;
  size_t components = 0;
  int type = 0;
  bool normalized = false;
};

template <class T>
float numberAt(const char* at, bool normalized) {
  T value;
  std::memcpy(&value, at, sizeof value);
  if (!normalized) return static_cast<float>(value);
  return std::max(static_cast<float>(value) / static_cast<float>(std::numeric_limits<T>::max()), -1.0F);
}

size_t bytesOf(int type) {
  return type == 5120 || type == 5121 ? 1 : type == 5122 || type == 5123 ? 2 : 0;
}

float numberAt(const Numbers& n, size_t item, size_t component) {
  const char* const at = n.items.at(item) + component * bytesOf(n.type);
  if (n.type == 5120) return numberAt<int8_t>(at, n.normalized);
  if (n.type == 5121) return numberAt<uint8_t>(at, n.normalized);
  return n.type == 5122 ? numberAt<int16_t>(at, n.normalized) : numberAt<uint16_t>(at, n.normalized);
}

class FloatGltf {
 public:
  FloatGltf(const std::string& path, const ImportLimits& limits) : file_(path, limits), json_(file_.json()) {}

  std::map<std::string, std::string> files() {
    for (const size_t accessor : attributes()) replace(accessor);
    json_["buffers"].push_back({{"uri", kNumbers}, {"byteLength", floats_.size()}});
    for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
      if (!json_.contains(list)) continue;
      Json kept = Json::array();
      for (const Json& name : json_[list])
        if (name != "KHR_mesh_quantization") kept.push_back(name);
      json_[list] = kept;
    }
    const std::string beside = (std::filesystem::path(file_.path()).parent_path() / kNumbers).string();
    return {{file_.path(), file_.bytes()}, {beside, floats_}};
  }

 private:
  /// Returns the integer accessors where assimp expects real numbers.
  std::set<size_t> attributes() const {
    std::set<size_t> out;
    for (const Json& mesh : json_.at("meshes"))
      for (const Json& primitive : mesh.at("primitives"))
        for (const auto& [name, accessor] : primitive.at("attributes").items()) {
          const bool is_real =
              name == "POSITION" || name == "NORMAL" || name == "TANGENT" || name.rfind("TEXCOORD_", 0) == 0;
          if (is_real && json_.at("accessors").at(accessor.get<size_t>()).at("componentType") != kFloat)
            out.insert(accessor.get<size_t>());
        }
    return out;
  }

  void replace(size_t index) {
    Json& accessor = json_.at("accessors").at(index);
    const Numbers numbers = numbersOf(accessor, index);
    const size_t before = floats_.size();
    for (size_t i = 0; i < numbers.items.count; ++i)
      for (size_t c = 0; c < numbers.components; ++c) {
        const float value = numberAt(numbers, i, c);
        floats_.append(reinterpret_cast<const char*>(&value), sizeof value);
      }
    accessor["bufferView"] = json_.at("bufferViews").size();
    accessor["componentType"] = kFloat;
    for (const char* key : {"byteOffset", "normalized", "min", "max"}) accessor.erase(key);
    json_.at("bufferViews")
        .push_back(
            {{"buffer", json_.at("buffers").size()}, {"byteOffset", before}, {"byteLength", floats_.size() - before}});
  }

  Numbers numbersOf(const Json& accessor, size_t index) {
    const std::string name = "accessor " + std::to_string(index);
    static const std::map<std::string, size_t> kComponents = {{"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}};
    Numbers out;
    out.type = accessor.at("componentType");
    const auto components = kComponents.find(accessor.at("type").get<std::string>());
    if (bytesOf(out.type) == 0 || components == kComponents.end() || accessor.contains("sparse") ||
        !accessor.contains("bufferView"))
      throw MeshError(name +
                      " has a type that is not supported; accepted: 2 to 4 whole numbers of 8 or 16 bits, not sparse");
    out.components = components->second;
    out.normalized = accessor.value("normalized", false);
    out.items = file_.items(index, out.components * bytesOf(out.type));
    return out;
  }

  GltfFile file_;
  Json& json_;
  std::string floats_;
};

}  // namespace

std::map<std::string, std::string> withFloatAttributes(const std::string& path, const ImportLimits& limits) {
  try {
    return FloatGltf(path, limits).files();
  } catch (const Json::exception& error) {
    throw MeshError(std::string("is corrupt: ") + error.what());
  }
}

}  // namespace viscera
