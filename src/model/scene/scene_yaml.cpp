// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scene/scene_yaml.h"

#include <yaml-cpp/yaml.h>

#include <cstdio>
#include <optional>
#include <utility>

#include "math/number_text.h"
#include "model/scene/scene_fields.h"
#include "model/scene/whole_scene_fields.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

namespace {

/// Field visitor that fills a map. Out-of-range values are defaults that mean "not given"; they are left out.
class MapFiller {
 public:
  explicit MapFiller(YAML::Node map) : map_(std::move(map)) {}

  void number(const char* key, double& value, Range range, const char*, const char*) {
    if (value >= range.min && value <= range.max) map_[key] = digits(value);
  }
  void numberOrAuto(const char* key, double& value, bool&, Range range, const char* unit, const char* text) {
    number(key, value, range, unit, text);
  }
  void integer(const char* key, int& value, Range range, const char*) {
    if (value >= range.min && value <= range.max) map_[key] = std::to_string(value);
  }
  void boolean(const char* key, bool& value, const char*) { map_[key] = value; }
  void text(const char* key, std::string& value, const char*) {
    if (!value.empty()) map_[key] = value;
  }
  void vector(const char* key, Vector3d& value, Range range, const char*, const char*) {
    if ((value.array() < range.min).any() || (value.array() > range.max).any()) return;
    for (const double component : value) map_[key].push_back(digits(component));
  }
  void vectorOrNone(const char* key, std::optional<Vector3d>& value, Range range, const char* unit, const char* text) {
    if (value) vector(key, *value, range, unit, text);
  }
  void given(bool& value) { given_ = value; }
  template <class E>
  void choice(const char* key, E& value, Choices<E> names, const char* text) {
    choice<E, Choices<E>>(key, value, names, text);
  }
  template <class E, class List>
  void choice(const char* key, E& value, const List& names, const char*) {
    for (const auto& n : names) {
      if (n.value == value) map_[key] = std::string(n.name);
    }
  }
  void texts(const char* key, std::vector<std::string>& values, double, const char*) {
    for (const std::string& value : values) map_[key].push_back(value);
  }
  template <class Struct>
  void tissue(const char* key, Struct& value, const char*) {
    if (!value.tissue.empty()) map_[key] = value.tissue;  // its numbers are written too, and take precedence
  }
  void names(const char* key, Overlays& value, const char*) {
    map_[key] = YAML::Node(YAML::NodeType::Sequence);
    for (const OverlayName& overlay : kOverlayNames) {
      if (value.has(overlay.value)) map_[key].push_back(std::string(overlay.name));
    }
  }
  template <class Struct>
  void group(const char* key, Struct& value, const char*) {
    YAML::Node map(YAML::NodeType::Map);
    if (fill(map, value)) map_[key] = map;
  }
  template <class Struct>
  void list(const char* key, std::vector<Struct>& values, double, const char*, const Struct& = {}) {
    YAML::Node list(YAML::NodeType::Sequence);
    for (Struct& value : values) {
      YAML::Node map(YAML::NodeType::Map);
      fill(map, value);
      list.push_back(map);
    }
    map_[key] = list;
  }

 private:
  static std::string digits(double value) { return exactText(value); }
  /// Fills a map.
  /// @returns whether the map is to be written
  template <class Struct>
  static bool fill(const YAML::Node& map, Struct& value) {
    MapFiller inner(map);
    visitFields(inner, value);
    return inner.given_;
  }

  YAML::Node map_;
  bool given_ = true;
};

}  // namespace

std::string resolvedYaml(const Scene& scene) {
  YAML::Node root(YAML::NodeType::Map);
  Scene copy = scene;  // visitors may change what they visit
  MapFiller filler(root);
  visitFields(filler, copy);
  YAML::Emitter out;
  out << root;
  return std::string(out.c_str()) + "\n";
}

}  // namespace viscera
