// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <yaml-cpp/yaml.h>

#include <array>
#include <set>
#include <string>
#include <vector>

#include "math/nearest_names.h"
#include "math/number_text.h"
#include "model/scene/scene_fields.h"
#include "model/scene/tissue_presets.h"
#include "model/scene/yaml/yaml_fault.h"

namespace viscera {

/// Source of a YAML document, for error messages.
struct YamlSource {
  std::string name;                  ///< name of the file
  std::set<std::string> overridden;  ///< key paths that were set by overrides

  bool sets(const std::string& path) const;  ///< whether the key, or a map that contains it, was set by an override
};

/// Error: a key that no scene has, or that this scene has no place for, whatever its value.
struct UnknownKeyError : SceneError {
  using SceneError::SceneError;
};

/// Strict reader of one map: a field visitor that takes the keys that are present; finish() refuses keys that no field
/// has.
/// @throws SceneError  file, line, key and what is accepted
class YamlReader {
 public:
  YamlReader(const YAML::Node& map, const std::string& path, const YamlSource& source);

  void number(const char* key, double& value, Range range, const char* unit, const char* text);
  void numberOrAuto(const char* key, double& value, bool& is_auto, Range range, const char* unit, const char* text);
  void integer(const char* key, int& value, Range range, const char* text);
  void boolean(const char* key, bool& value, const char* text);
  void text(const char* key, std::string& value, const char* text);
  void vector(const char* key, Vector3d& value, Range range, const char* unit, const char* text);
  void vectorOrNone(const char* key, std::optional<Vector3d>& value, Range range, const char* unit, const char* text);
  /// Reads a list of exactly N numbers.
  template <size_t N>
  void numbers(const char* key, std::array<double, N>& values, Range range, const char* unit) {
    const YAML::Node node = take(key);
    if (!node) return;
    requireNumbers(key, node, N, range, unit);
    for (size_t i = 0; i < N; ++i) values[i] = scalar(key, node[i], range, unit);
  }
  /// Reads a list of any number of numbers.
  void numbers(const char* key, std::vector<double>& values, double max_count, Range range, const char* unit);
  /// Reads a text of several lines, which may be empty. @param first_line  set to its first line in the file, if given
  void block(const char* key, std::string& value, int& first_line, const char* text);
  /// Reads a list of any number of texts.
  void texts(const char* key, std::vector<std::string>& values, double max_count, const char* text);
  void names(const char* key, Overlays& value, const char* text);
  /// Reads a list of x, y, z, w, of length 1 within a hundredth; normalised.
  void quaternion(const char* key, Quaterniond& value, const char* text);
  void given(bool& value) const { value = true; }  ///< a map that is being read is present

  template <class E, class List>
  void choice(const char* key, E& value, const List& names, const char*) {
    const YAML::Node node = take(key);
    if (!node) return;
    std::vector<std::string> accepted;
    for (const auto& n : names) {
      if (node.IsScalar() && node.Scalar() == n.name) {
        value = n.value;
        return;
      }
      accepted.emplace_back(n.name);
    }
    if (node.IsScalar()) failIfRemoved(key, node);
    fail(key, node, "must be one of " + nearestFirstText(node.IsScalar() ? node.Scalar() : "", accepted));
  }
  template <class E>
  void choice(const char* key, E& value, Choices<E> names, const char* text) {
    choice<E, Choices<E>>(key, value, names, text);
  }
  template <class Struct>
  void tissue(const char* key, Struct& value, const char* text) {
    std::vector<Choice<std::string>> presets;
    for (const TissuePreset& preset : tissuePresets()) presets.push_back({preset.name, preset.name});
    choice(key, value.tissue, presets, text);
    if (has(key)) takeTissue(value);
  }
  template <class Struct>
  void group(const char* key, Struct& value, const char*) {
    const YAML::Node node = take(key);
    if (node) readMap(node, child(key), source_, value);
  }
  template <class Struct>
  void listedGroup(const char* key, Struct& value, const char* text) {
    group(key, value, text);
  }
  template <class Struct>
  void list(const char* key, std::vector<Struct>& values, double max_count, const char*, const Struct& prototype = {}) {
    const YAML::Node node = take(key);
    if (!node) return;
    requireList(key, node, max_count);
    values.clear();
    for (size_t i = 0; i < node.size(); ++i) {
      values.push_back(prototype);
      readMap(node[i], child(key) + "[" + std::to_string(i) + "]", source_, values.back());
    }
  }
  /// Checks that all keys were used.
  /// @throws SceneError if the map holds a key that no field has
  void finish() const;
  bool has(const char* key) const { return map_[key].IsDefined(); }
  /// Returns the line of the file where the map begins, from 1.
  int line() const { return map_.Mark().line + 1; }

  template <class Struct>
  static void readMap(const YAML::Node& map, const std::string& path, const YamlSource& source, Struct& value) {
    YamlReader reader(map, path, source);
    visitFields(reader, value);
    reader.finish();
  }

 private:
  YAML::Node take(const char* key);
  /// @param more  other accepted values besides the number, for the error
  double scalar(const char* key, const YAML::Node& node, Range range, const std::string& unit,
                const std::string& more = "") const;
  void requireNumbers(const char* key, const YAML::Node& node, size_t count, Range range, const char* unit) const;
  void requireList(const char* key, const YAML::Node& node, double max_count) const;
  std::string child(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }
  YAML::Node keyNode(const std::string& key) const;
  /// @throws SceneError  the value was accepted by an earlier version: names its replacement
  void failIfRemoved(const std::string& key, const YAML::Node& node) const;
  [[noreturn]] void fail(const std::string& key, const YAML::Node& node, const std::string& accepted) const;

  const YAML::Node map_;
  std::string path_;
  const YamlSource& source_;
  std::vector<std::string> known_;
};

/// Returns "file:line: " of a node; "override: " for one that was set by an override.
std::string whereIs(const YamlSource& source, const std::string& path, const YAML::Node& node);

/// Returns the content of a text file. @param what  expected content, for errors
/// @throws SceneError  it is a folder, cannot be read, or does not end within the accepted size
std::string textOf(const std::string& path, const std::string& what);

}  // namespace viscera
