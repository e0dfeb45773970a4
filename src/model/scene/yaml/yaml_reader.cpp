// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scene/yaml/yaml_reader.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "math/memory_for.h"
#include "math/nearest_names.h"
#include "math/out_file.h"
#include "model/scene/yaml/removed_keys.h"
#include "model/scene/yaml/renamed_keys.h"
#include "viscera/math/error.h"

namespace viscera {

namespace {

std::string shown(const YAML::Node& node) {
  if (node.IsScalar()) return "'" + node.Scalar() + "'";
  if (node.IsSequence()) return "a list of " + std::to_string(node.size()) + (node.size() == 1 ? " item" : " items");
  return node.IsMap() ? "a map" : "nothing";
}

/// Reads as YAML::convert<double>, but without the program's locale.
bool decode(const std::string& text, double& value) {
  TextIn in(text);
  return in >> value && (in >> std::ws).eof();
}

std::string rangeText(Range range, const std::string& unit) {
  return numberText(range.min) + " .. " + numberText(range.max) + (unit.empty() || unit == "1" ? "" : " " + unit);
}

}  // namespace

std::string textOf(const std::string& path, const std::string& what) {
  constexpr size_t kMostMb = 100, kBytesPerMb = 1000000;  // some million keys of strokes
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) throw SceneError(path + ": is a folder, not a " + what + " file");
  recordRead(path);
  std::ifstream file(path, std::ios::binary);
  if (!file) throw SceneError(path + ": cannot be read (does the file exist?)");
  return memoryFor<SceneError>(path, [&] {
    std::string text;
    std::vector<char> piece(kBytesPerMb);
    do {  // in pieces, as a device has no end
      file.read(piece.data(), static_cast<std::streamsize>(piece.size()));
      text.append(piece.data(), static_cast<size_t>(file.gcount()));
    } while (file && text.size() <= kMostMb * kBytesPerMb);
    if (!file) return text;
    throw SceneError(path + ": is larger than " + std::to_string(kMostMb) + " MB, the limit for a " + what + " file");
  });
}

bool YamlSource::sets(const std::string& path) const {
  return std::any_of(overridden.begin(), overridden.end(), [&](const std::string& set) {
    return path == set || path.rfind(set + ".", 0) == 0 || path.rfind(set + "[", 0) == 0;
  });
}

std::string whereIs(const YamlSource& source, const std::string& path, const YAML::Node& node) {
  if (source.sets(path)) return "override: ";
  if (node.Mark().is_null() && !source.overridden.empty()) return "override: ";  // a map created for an override
  return source.name + ":" + std::to_string(node.Mark().line + 1) + ": ";
}

YamlReader::YamlReader(const YAML::Node& map, const std::string& path, const YamlSource& source)
    : map_(map), path_(path), source_(source) {
  if (!map.IsMap()) {
    throw SceneError(whereIs(source, path, map) + (path.empty() ? "the file" : "'" + path + "'") +
                     " must be a map of keys, not " + shown(map));
  }
  std::set<std::string> seen;
  for (const auto& entry : map) {
    if (!seen.insert(entry.first.Scalar()).second) {
      throw SceneError(whereIs(source, path, entry.first) + "key '" + child(entry.first.Scalar()) + "' is given twice");
    }
  }
}

YAML::Node YamlReader::take(const char* key) {
  known_.push_back(key);
  const YAML::Node node = map_[key];
  if (!node.IsDefined()) return YAML::Node(YAML::NodeType::Undefined);
  return node;
}

YAML::Node YamlReader::keyNode(const std::string& key) const {
  for (const auto& entry : map_) {
    if (entry.first.Scalar() == key) return entry.first;
  }
  return map_;
}

void YamlReader::fail(const std::string& key, const YAML::Node& node, const std::string& accepted) const {
  const YAML::Node location = node.IsNull() ? keyNode(key) : node;  // an empty value has the line of the next token
  throw SceneError(whereIs(source_, child(key), location) + "'" + child(key) + "' " + accepted + "; found " +
                   shown(node));
}

void YamlReader::failIfRemoved(const std::string& key, const YAML::Node& node) const {
  const std::string note = removedNote(child(key), node.Scalar());
  if (!note.empty())
    throw SceneError(whereIs(source_, child(key), node) + "'" + child(key) + ": " + node.Scalar() + "' " + note);
}

double YamlReader::scalar(const char* key, const YAML::Node& node, Range range, const std::string& unit,
                          const std::string& more) const {
  double value = 0;
  const bool is_number = node.IsScalar() && decode(node.Scalar(), value);
  if (!is_number || !std::isfinite(value) || value < range.min || value > range.max) {
    fail(key, node, "must be a number, " + rangeText(range, unit) + more);
  }
  return value;
}

void YamlReader::number(const char* key, double& value, Range range, const char* unit, const char*) {
  const YAML::Node node = take(key);
  if (node) value = scalar(key, node, range, unit);
}

void YamlReader::numberOrAuto(const char* key, double& value, bool& is_auto, Range range, const char* unit,
                              const char*) {
  const YAML::Node node = take(key);
  if (!node) return;
  is_auto = node.IsScalar() && node.Scalar() == "auto";
  if (!is_auto) value = scalar(key, node, range, unit, ", or auto");
}

void YamlReader::integer(const char* key, int& value, Range range, const char*) {
  const YAML::Node node = take(key);
  if (!node) return;
  const double number = scalar(key, node, range, "");
  if (number != std::floor(number)) fail(key, node, "must be a whole number, " + rangeText(range, ""));
  value = static_cast<int>(number);
}

void YamlReader::boolean(const char* key, bool& value, const char*) {
  const YAML::Node node = take(key);
  if (node && (!node.IsScalar() || !YAML::convert<bool>::decode(node, value))) fail(key, node, "must be true or false");
}

void YamlReader::text(const char* key, std::string& value, const char*) {
  const YAML::Node node = take(key);
  if (!node) return;
  if (!node.IsScalar() || node.Scalar().empty()) fail(key, node, "must be a non-empty string");
  value = node.Scalar();
}

void YamlReader::vector(const char* key, Vector3d& value, Range range, const char* unit, const char*) {
  const YAML::Node node = take(key);
  if (!node) return;
  requireNumbers(key, node, 3, range, unit);
  for (size_t i = 0; i < 3; ++i) value[static_cast<Eigen::Index>(i)] = scalar(key, node[i], range, unit);
}

void YamlReader::vectorOrNone(const char* key, std::optional<Vector3d>& value, Range range, const char* unit,
                              const char* text) {
  Vector3d read = Vector3d::Zero();
  if (map_[key].IsDefined()) value = read;
  vector(key, value ? *value : read, range, unit, text);
}

void YamlReader::numbers(const char* key, std::vector<double>& values, double max_count, Range range,
                         const char* unit) {
  const YAML::Node node = take(key);
  if (!node) return;
  requireList(key, node, max_count);
  values.clear();
  for (const YAML::Node& number : node) values.push_back(scalar(key, number, range, unit));
}

void YamlReader::block(const char* key, std::string& value, int& first_line, const char*) {
  const YAML::Node node = take(key);
  if (!node) return;
  if (!node.IsScalar()) fail(key, node, "must be a block of lines that begins with '|'");
  value = node.Scalar();
  first_line = keyNode(key).Mark().line + 2;
}

void YamlReader::quaternion(const char* key, Quaterniond& value, const char*) {
  constexpr double kLengthTolerance = 0.01;  // four decimals, as a person writes them
  const YAML::Node node = take(key);
  if (!node) return;
  const std::string accepted = "must be a list of x, y, z, w, a quaternion of length 1";
  if (!node.IsSequence() || node.size() != 4) fail(key, node, accepted);
  Eigen::Vector4d xyzw;
  for (size_t i = 0; i < 4; ++i) xyzw[static_cast<Eigen::Index>(i)] = scalar(key, node[i], {-1, 1}, "");
  if (std::abs(xyzw.norm() - 1) > kLengthTolerance) fail(key, node, accepted);
  value = Quaterniond(xyzw[3], xyzw[0], xyzw[1], xyzw[2]).normalized();
}

void YamlReader::names(const char* key, Overlays& value, const char*) {
  const YAML::Node node = take(key);
  if (!node) return;
  const std::string accepted = "must be a list of names out of " + overlayNames();
  if (!node.IsSequence()) fail(key, node, accepted);
  std::vector<std::string> names;
  for (const YAML::Node& name : node) {
    if (!name.IsScalar()) fail(key, name, accepted);
    names.push_back(name.Scalar());
  }
  try {
    value = overlaysOf(names);
  } catch (const SceneError& error) {
    throw SceneError(whereIs(source_, child(key), node) + "'" + child(key) + "': " + error.what());
  }
}

void YamlReader::texts(const char* key, std::vector<std::string>& values, double max_count, const char*) {
  const YAML::Node node = take(key);
  if (!node) return;
  requireList(key, node, max_count);
  values.clear();
  for (const YAML::Node& text : node) {
    if (!text.IsScalar()) fail(key, text, "must be a list of strings");
    values.push_back(text.Scalar());
  }
}

void YamlReader::requireNumbers(const char* key, const YAML::Node& node, size_t count, Range range,
                                const char* unit) const {
  if (!node.IsSequence() || node.size() != count)
    fail(key, node, "must be a list of " + std::to_string(count) + " numbers, " + rangeText(range, unit));
}

void YamlReader::requireList(const char* key, const YAML::Node& node, double max_count) const {
  if (!node.IsSequence() || static_cast<double>(node.size()) > max_count) {
    fail(key, node, "must be a list of at most " + numberText(max_count) + " items");
  }
}

void YamlReader::finish() const {
  for (const auto& entry : map_) {
    const std::string key = entry.first.Scalar();
    if (std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
    const std::string note = removedNote(child(key));
    if (!note.empty()) throw SceneError(whereIs(source_, child(key), entry.first) + "'" + child(key) + "' " + note);
    const std::string renamed = withNewNames(child(key));
    if (renamed != child(key))
      throw SceneError(whereIs(source_, child(key), entry.first) + "'" + child(key) + "' is named '" + renamed +
                       "' in this version; `viscera upgrade FILE` renames the keys of a file");
    throw UnknownKeyError(whereIs(source_, child(key), entry.first) + "unknown key '" + child(key) +
                          "'; accepted here: " + nearestFirstText(key, known_));
  }
}

}  // namespace viscera
