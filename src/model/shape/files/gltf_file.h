// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "viscera/model/scene/body_config.h"

namespace viscera {

/// A glTF or GLB file as JSON and buffers, beside what a library makes of it. gltf_limits.h has looked at it before.
class GltfFile {
 public:
  /// @throws MeshError, nlohmann::json::exception  it cannot be read
  GltfFile(std::string path, const ImportLimits& limits);

  nlohmann::json& json() { return json_; }
  const std::string& path() const { return path_; }

  /// Bytes that an accessor's items have in a buffer.
  struct Items {
    const std::string* buffer = nullptr;
    size_t first = 0, stride = 0, count = 0;
    const char* at(size_t item) const { return buffer->data() + first + item * stride; }
  };
  /// Returns where the items of an accessor are; it has a bufferView.
  /// @param item_bytes  of one item
  /// @throws MeshError  they reach beyond their buffer
  Items items(size_t accessor, size_t item_bytes);
  /// Returns a file of the same format with json() as it is now, and the same chunks of a GLB.
  std::string bytes() const;

 private:
  const std::string& buffer(size_t index);

  std::string path_;
  ImportLimits limits_;
  nlohmann::json json_;
  bool is_glb_ = false;
  std::string binary_, rest_;  ///< of GLB: its buffer, and all chunks after its JSON
  std::map<size_t, std::string> buffers_;
};

}  // namespace viscera
