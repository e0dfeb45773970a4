// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace viscera {

/// Node tree of a glTF file, as numbers.
struct GltfTree {
  struct Node {
    std::vector<uint64_t> children;
    std::vector<uint64_t> meshes;
  };
  /// Indices of accessors. Accessors of attributes have one length, those of targets come on top.
  struct Primitive {
    std::vector<uint64_t> accessors, of_targets;
    std::vector<uint64_t> reals;    ///< accessors that readers expect to have real numbers
    std::vector<uint64_t> indices;  ///< at most one
    uint64_t mode = kTriangles;
  };
  static constexpr uint64_t kTriangles = 4;

  std::string version;
  std::vector<std::string> required;  ///< extensions that the file needs
  std::vector<Node> nodes;
  std::vector<std::vector<uint64_t>> scenes;  ///< their root nodes
  std::vector<std::vector<Primitive>> meshes;
  std::vector<double> accessor_counts, buffer_bytes;
  std::vector<uint64_t> component_types;  ///< [accessors] OpenGL's numbers; 0: not given
};

/// Handler of a JSON parser's events that fills a GltfTree. Memory does not grow with what it does not keep.
///
/// A parsed document would be unsafe for hostile files. TinyGLTF and assimp build the whole tree before any limit is
/// checked. nlohmann's own tree (3.11) takes 36 bytes per byte of nested brackets. With a callback as filter its time
/// grows with the square of a list's length. It also keeps the last of equal keys where assimp reads the first.
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

  std::string fault;  ///< reason why reading ended; empty: the end was reached

 private:
  struct Level {
    bool is_array;
    size_t index;  ///< index of the next value, from 1; 0: none yet
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
