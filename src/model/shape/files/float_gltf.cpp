// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/files/float_gltf.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <vector>

#include "model/scene/file_bounds.h"
#include "model/shape/files/import_limits.h"
#include "model/shape/files/mesh_look.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

using Json = nlohmann::json;

constexpr const char* kNumbers = "viscera-floats.bin";  ///< the name of what is beside the file, and nowhere
constexpr int kFloat = 5126;
constexpr size_t kGlbHeader = 12, kChunkHeader = 8;

std::string contentsOf(const std::string& path, const ImportLimits& limits) {
  requireWithinBounds(path);
  requireFileSize(path, limits);
  std::ifstream file(path, std::ios::binary);
  std::ostringstream all;
  all << file.rdbuf();
  if (!file) throw MeshError("could not open referenced file \"" + path + "\"");
  return all.str();
}

std::string wordOf(size_t value) {
  const auto word = static_cast<uint32_t>(value);
  return {reinterpret_cast<const char*>(&word), sizeof word};
}

uint32_t headerWord(const std::string& bytes, size_t at) {
  uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, sizeof word);
  return word;
}

std::string fromBase64(const std::string& text) {
  static const std::string kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  unsigned bits = 0, count = 0;
  for (const char c : text) {
    const size_t digit = kDigits.find(c);
    if (digit == std::string::npos) break;  // padding
    bits = bits << 6 | static_cast<unsigned>(digit);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    out += static_cast<char>(bits >> count & 255);
  }
  return out;
}

/// How the numbers of an accessor lie in a buffer.
struct Numbers {
  const std::string* buffer = nullptr;
  size_t first = 0, stride = 0, count = 0, components = 0;
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
  const char* const at = n.buffer->data() + n.first + item * n.stride + component * bytesOf(n.type);
  if (n.type == 5120) return numberAt<int8_t>(at, n.normalized);
  if (n.type == 5121) return numberAt<uint8_t>(at, n.normalized);
  return n.type == 5122 ? numberAt<int16_t>(at, n.normalized) : numberAt<uint16_t>(at, n.normalized);
}

class FloatGltf {
 public:
  FloatGltf(std::string path, const ImportLimits& limits) : path_(std::move(path)), limits_(limits) {
    std::string text = contentsOf(path_, limits_);
    if (text.compare(0, 4, "glTF") == 0) {  // whose chunks gltf_limits.h has looked at
      const size_t json_bytes = headerWord(text, kGlbHeader), end = kGlbHeader + kChunkHeader + json_bytes;
      rest_ = text.substr(end);
      if (rest_.size() >= kChunkHeader) binary_ = rest_.substr(kChunkHeader, headerWord(rest_, 0));
      text = text.substr(kGlbHeader + kChunkHeader, json_bytes);
      is_glb_ = true;
    }
    text.resize(std::min(text.size(), text.find('\0')));
    json_ = Json::parse(text);
  }

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
    const std::string beside = (std::filesystem::path(path_).parent_path() / kNumbers).string();
    return {{path_, asFile(json_.dump(-1, ' ', false, Json::error_handler_t::replace))}, {beside, floats_}};
  }

 private:
  /// Accessors of whole numbers where assimp expects real ones.
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
    for (size_t i = 0; i < numbers.count; ++i)
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
                      " is of a kind that is not read; accepted: 2 to 4 whole numbers of 8 or 16 bits, not sparse");
    const Json& view = json_.at("bufferViews").at(accessor.at("bufferView").get<size_t>());
    out.components = components->second;
    out.count = accessor.at("count");
    out.normalized = accessor.value("normalized", false);
    const size_t item = out.components * bytesOf(out.type);
    out.stride = view.value("byteStride", item);
    out.first = view.value("byteOffset", size_t{0}) + accessor.value("byteOffset", size_t{0});
    out.buffer = &buffer(view.at("buffer"));
    const size_t held = out.buffer->size();
    if (out.count > held || out.stride > held || out.first > held ||
        (out.count > 0 && out.first + (out.count - 1) * out.stride + item > held))
      throw MeshError("is corrupt: " + name + " reaches beyond its buffer");
    return out;
  }

  const std::string& buffer(size_t index) {
    const auto known = buffers_.find(index);
    if (known != buffers_.end()) return known->second;
    const Json& buffer = json_.at("buffers").at(index);
    if (!buffer.contains("uri")) return binary_;
    const std::string uri = buffer.at("uri");
    const size_t comma = uri.find(',');
    if (uri.rfind("data:", 0) == 0 && comma != std::string::npos)
      return buffers_[index] = fromBase64(uri.substr(comma + 1));
    const std::filesystem::path folder = std::filesystem::path(path_).parent_path();
    std::error_code error;
    const bool plain = std::filesystem::is_regular_file(folder / uri, error);
    return buffers_[index] = contentsOf((folder / (plain ? uri : unescaped(uri))).string(), limits_);
  }

  std::string asFile(std::string json) const {
    if (!is_glb_) return json;
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const size_t bytes = kGlbHeader + kChunkHeader + json.size() + rest_.size();
    return "glTF" + wordOf(2) + wordOf(bytes) + wordOf(json.size()) + "JSON" + json + rest_;
  }

  std::string path_;
  ImportLimits limits_;
  Json json_;
  bool is_glb_ = false;
  std::string binary_, rest_;  ///< of GLB: its buffer, and all chunks after its JSON
  std::map<size_t, std::string> buffers_;
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
