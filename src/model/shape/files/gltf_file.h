// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "viscera/model/scene/body_config.h"

namespace viscera {

/// glTF or GLB file as JSON and buffers, read without a library. requireGltfWithin() (gltf_limits.h) must have accepted
/// it.
class GltfFile {
 public:
  /// @throws MeshError, nlohmann::json::exception  it cannot be read
  GltfFile(std::string path, const ImportLimits& limits);

  nlohmann::json& json() { return json_; }
  const std::string& path() const { return path_; }

  /// Bytes of an accessor's items in a buffer.
  struct Items {
    const std::string* buffer = nullptr;
    size_t first = 0, stride = 0, count = 0;
    const char* at(size_t item) const { return buffer->data() + first + item * stride; }
  };
  /// Returns the bytes of an accessor's items; the accessor has a bufferView.
  /// @param item_bytes  size of one item
  /// @throws MeshError  they reach beyond their buffer
  Items items(size_t accessor, size_t item_bytes);
  /// Returns a file of the same format with json() as it is now, and the same other chunks for a GLB.
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
