// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace viscera {

/// What glTF says of its nodes, as numbers.
struct GltfTree {
  struct Node {
    std::vector<uint64_t> children;
    std::vector<uint64_t> meshes;
  };
  /// Accessors by number. Those of attributes and indices are as long as each other, those of targets come on top.
  struct Primitive {
    std::vector<uint64_t> accessors, of_targets;
    std::vector<uint64_t> reals;    ///< accessors of what readers expect as real numbers
    std::vector<uint64_t> indices;  ///< one at most
    uint64_t mode = kTriangles;
  };
  static constexpr uint64_t kTriangles = 4;

  std::string version;
  std::vector<std::string> required;  ///< extensions without which the file cannot be read
  std::vector<Node> nodes;
  std::vector<std::vector<uint64_t>> scenes;  ///< their root nodes
  std::vector<std::vector<Primitive>> meshes;
  std::vector<double> accessor_counts, buffer_bytes;
  std::vector<uint64_t> component_types;  ///< [accessors] as OpenGL numbers them; 0: not said
};

/// Fills a GltfTree from the events of a JSON parser. Its memory does not grow with what it does not keep.
///
/// A parsed document cannot take its place for hostile files. TinyGLTF and assimp build the whole tree before any limit
/// is known; nlohmann's own tree (3.11) takes 36 bytes per byte of nested brackets, takes time that grows with the
/// square of a list's length if a callback filters it, and keeps the last of equal keys where assimp reads the first.
class GltfTreeReader : public nlohmann::json_sax<nlohmann::json> {
 public:
  explicit GltfTreeReader(GltfTree& tree) : tree_(tree) {}

  bool null() override { return value(); }
  bool boolean(bool) override { return value(); }
  bool number_integer(number_integer_t) override { return value(); }
  bool number_unsigned(number_unsigned_t number) override;
  bool number_float(number_float_t, const string_t&) override { return value(); }
  bool string(string_t& text) override;
  bool binary(binary_t&) override { return value(); }
  bool start_object(std::size_t) override { return open(false); }
  bool start_array(std::size_t) override { return open(true); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }
  bool key(string_t& name) override;
  bool parse_error(std::size_t byte, const std::string&, const nlohmann::json::exception&) override;

  std::string fault;  ///< why reading ended; empty: the end was reached

 private:
  struct Level {
    bool is_array;
    size_t index;  ///< of the value to come, from 1; 0: none was yet
    std::string key;
  };
  bool value();
  bool open(bool is_array);
  bool close();
  std::string path() const;
  size_t at(size_t level) const { return levels_[level].index - 1; }
  void keep(uint64_t number);
  void keepOfMesh(uint64_t number, const std::string& where);

  GltfTree& tree_;
  std::vector<Level> levels_;
};

}  // namespace viscera
