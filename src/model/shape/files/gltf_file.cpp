// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/files/gltf_file.h"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "model/scene/file_bounds.h"
#include "model/shape/files/gltf_limits.h"
#include "model/shape/files/import_limits.h"
#include "model/shape/files/mesh_appearance.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

using Json = nlohmann::json;

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

uint32_t firstWord(const std::string& bytes) {
  uint32_t word = 0;
  std::memcpy(&word, bytes.data(), sizeof word);
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

}  // namespace

GltfFile::GltfFile(std::string path, const ImportLimits& limits) : path_(std::move(path)), limits_(limits) {
  GltfText text = splitGltf(contentsOf(path_, limits_));
  is_glb_ = text.is_glb;
  rest_ = std::move(text.chunks);
  if (rest_.size() >= kChunkHeader) binary_ = rest_.substr(kChunkHeader, firstWord(rest_));
  json_ = Json::parse(text.json);
}

GltfFile::Items GltfFile::items(size_t accessor_index, size_t item_bytes) {
  const Json& accessor = json_.at("accessors").at(accessor_index);
  const Json& view = json_.at("bufferViews").at(accessor.at("bufferView").get<size_t>());
  Items out;
  out.count = accessor.at("count");
  out.stride = view.value("byteStride", item_bytes);
  out.first = view.value("byteOffset", size_t{0}) + accessor.value("byteOffset", size_t{0});
  out.buffer = &buffer(view.at("buffer"));
  const size_t held = out.buffer->size();
  if (out.count > held || out.stride > held || out.first > held ||
      (out.count > 0 && out.first + (out.count - 1) * out.stride + item_bytes > held))
    throw MeshError("is corrupt: accessor " + std::to_string(accessor_index) + " reaches beyond its buffer");
  return out;
}

std::string GltfFile::bytes() const {
  std::string json = json_.dump(-1, ' ', false, Json::error_handler_t::replace);
  if (!is_glb_) return json;
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const size_t bytes = kGlbHeader + kChunkHeader + json.size() + rest_.size();
  return "glTF" + wordOf(2) + wordOf(bytes) + wordOf(json.size()) + "JSON" + json + rest_;
}

const std::string& GltfFile::buffer(size_t index) {
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

}  // namespace viscera
