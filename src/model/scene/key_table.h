// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "math/number_text.h"
#include "model/scene/scene_fields.h"
#include "model/scene/yaml/yaml_reader.h"
#include "viscera/model/scene/overlays.h"

namespace viscera {

/// Field visitor that writes one table row per key.
class KeyTable {
 public:
  explicit KeyTable(std::ostringstream& out, std::string path = "") : out_(out), path_(std::move(path)) {}

  void number(const char* key, double& value, Range range, const char* unit, const char* text) {
    row(key, withUnit("number", unit), numberText(value), span(range), text);
  }
  void numberOrAuto(const char* key, double& value, bool&, Range range, const char* unit, const char* text) {
    row(key, withUnit("number or auto", unit), numberText(value), span(range), text);
  }
  void integer(const char* key, int& value, Range range, const char* text) {
    row(key, "integer", std::to_string(value), span(range), text);
  }
  void boolean(const char* key, bool& value, const char* text) {
    row(key, "true or false", value ? "true" : "false", "", text);
  }
  void text(const char* key, std::string& value, const char* text) { row(key, "text", value, "", text); }
  void vector(const char* key, Vector3d& value, Range range, const char* unit, const char* text) {
    TextOut shown;
    shown << "[" << value.x() << ", " << value.y() << ", " << value.z() << "]";
    row(key, withUnit("3 numbers", unit), shown.str(), span(range), text);
  }
  void vectorOrNone(const char* key, std::optional<Vector3d>&, Range range, const char* unit, const char* text) {
    row(key, withUnit("3 numbers", unit), "", span(range), text);
  }
  void quaternion(const char* key, Quaterniond&, const char* text) {
    row(key, "4 numbers", "[0, 0, 0, 1]", "length 1", text);
  }
  void given(bool&) {}
  template <class E>
  void choice(const char* key, E& value, Choices<E> names, const char* text) {
    choice<E, Choices<E>>(key, value, names, text);
  }
  template <class E, class List>
  void choice(const char* key, E& value, const List& names, const char* text) {
    std::string all, chosen;
    for (const auto& n : names) {
      all += std::string(all.empty() ? "" : ", ") + n.name;
      if (n.value == value) chosen = n.name;
    }
    row(key, "choice", chosen, all, text);
  }
  void texts(const char* key, std::vector<std::string>&, double max_count, const char* text) {
    row(key, "list of texts", "[]", "at most " + numberText(max_count), text);
  }
  void names(const char* key, Overlays&, const char* text) { row(key, "list of names", "[]", overlayNames(), text); }
  template <class Struct>
  void tissue(const char* key, Struct&, const char* text) {
    row(key, "choice", "", "those of docs/tissues.md", text);
  }
  template <class Struct>
  void listedGroup(const char* key, Struct&, const char* text) {
    row(key, "map", "", "", text);
  }
  template <class Struct>
  void group(const char* key, Struct& value, const char* text) {
    row(key, "map", "", "", text);
    KeyTable inner(out_, path_ + key + ".");
    visitFields(inner, value);
  }
  template <class Struct>
  void list(const char* key, std::vector<Struct>&, double max_count, const char* text, const Struct& item = {}) {
    row(key, "list", "", "at most " + numberText(max_count), text);
    Struct defaults = item;
    KeyTable inner(out_, path_ + key + "[].");
    visitFields(inner, defaults);
  }

 private:
  static std::string withUnit(const std::string& type, const std::string& unit) {
    return unit.empty() || unit == "1" ? type : type + ", " + unit;
  }
  static std::string span(Range range) { return numberText(range.min) + " .. " + numberText(range.max); }
  void row(const std::string& key, const std::string& type, const std::string& value, const std::string& range,
           const std::string& text) {
    out_ << "| `" << path_ << key << "` | " << type << " | " << value << " | " << range << " | " << text << " |\n";
  }

  std::ostringstream& out_;
  std::string path_;
};

/// Returns a Markdown table of all keys of a file that a `Struct` represents, with their defaults.
template <class Struct>
std::string keyTable() {
  TextOut out;
  out << "| key | type, unit | default | range | meaning |\n|---|---|---|---|---|\n";
  Struct defaults;
  KeyTable table(out);
  visitFields(table, defaults);
  return out.str();
}

}  // namespace viscera
