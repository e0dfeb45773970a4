// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scene/scene_text.h"

#include <optional>
#include <utility>
#include <vector>

#include "math/number_text.h"
#include "model/scene/scene_fields.h"
#include "model/scene/whole_scene_fields.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

namespace {

/// Field visitor that writes one line per key.
class KeyValues {
 public:
  explicit KeyValues(std::string& out, std::string path = "") : out_(out), path_(std::move(path)) {}

  void number(const char* key, double& value, Range, const char*, const char*) { line(key, exactText(value)); }
  void numberOrAuto(const char* key, double& value, bool&, Range, const char*, const char*) {
    line(key, exactText(value));
  }
  void integer(const char* key, int& value, Range, const char*) { line(key, std::to_string(value)); }
  void boolean(const char* key, bool& value, const char*) { line(key, value ? "true" : "false"); }
  void text(const char* key, std::string& value, const char*) { line(key, value); }
  void vector(const char* key, Vector3d& value, Range, const char*, const char*) {
    line(key, exactText(value.x()) + " " + exactText(value.y()) + " " + exactText(value.z()));
  }
  void vectorOrNone(const char* key, std::optional<Vector3d>& value, Range range, const char* unit, const char* text) {
    if (value) vector(key, *value, range, unit, text);
  }
  void quaternion(const char* key, Quaterniond& value, const char*) {
    line(key,
         exactText(value.x()) + " " + exactText(value.y()) + " " + exactText(value.z()) + " " + exactText(value.w()));
  }
  void given(bool&) {}
  template <class E>
  void choice(const char* key, E& value, Choices<E> names, const char* text) {
    choice<E, Choices<E>>(key, value, names, text);
  }
  template <class E, class List>
  void choice(const char* key, E& value, const List& names, const char*) {
    for (const auto& n : names) {
      if (n.value == value) line(key, n.name);
    }
  }
  void texts(const char* key, std::vector<std::string>& values, double, const char*) {
    for (size_t i = 0; i < values.size(); ++i) line((key + ("[" + std::to_string(i) + "]")).c_str(), values[i]);
  }
  template <class Struct>
  void tissue(const char*, Struct&, const char*) {}   // its numbers are listed themselves
  void names(const char*, Overlays&, const char*) {}  // appearance only
  template <class Struct>
  void group(const char* key, Struct& value, const char*) {
    KeyValues inner(out_, path_ + key + ".");
    visitFields(inner, value);
  }
  template <class Struct>
  void list(const char* key, std::vector<Struct>& values, double, const char*, const Struct& = {}) {
    for (size_t i = 0; i < values.size(); ++i) {
      KeyValues inner(out_, path_ + key + "[" + std::to_string(i) + "].");
      visitFields(inner, values[i]);
    }
  }

 private:
  void line(const char* key, const std::string& value) { out_ += path_ + key + "=" + value + "\n"; }

  std::string& out_;
  std::string path_;
};

}  // namespace

std::string sceneText(const Scene& scene) {
  std::string out;
  Scene copy = scene;  // visitors may change what they visit
  KeyValues values(out);
  visitFields(values, copy);
  return out;
}

}  // namespace viscera
