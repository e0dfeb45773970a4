// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <yaml-cpp/yaml.h>

#include <array>
#include <fstream>

#include "math/out_file.h"
#include "model/scan/labels.h"
#include "model/scan/text_header.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

constexpr uint64_t kMostTableBytes = 1 << 20;
constexpr size_t kMostNames = 65536;

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// Parses a line of ITK-SNAP: number, red, green, blue, opacity, two flags, "name".
LabelName tableRow(const std::string& path, int number, const std::string& line) {
  const size_t open = line.find('"'), close = line.rfind('"');
  LabelName label;
  std::vector<std::string> fields;
  if (open != std::string::npos && close > open) fields = words(line.substr(0, open));
  std::array<double, 6> numbers{};  // red, green, blue, 0..255, and what is not used
  bool good = fields.size() == 7 && parseInteger(fields[0], label.value);
  for (size_t n = 0; good && n < numbers.size(); ++n) good = parseNumber(fields[n + 1], numbers.at(n));
  if (!good)
    throw SceneError(
        path + ":" + std::to_string(number) +
        ": not a row of an ITK-SNAP table; accepted: 'number red green blue opacity shown meshed \"name\"'");
  label.name = line.substr(open + 1, close - open - 1);
  label.color = (Vector3d(numbers[0], numbers[1], numbers[2]) / 255).cwiseMax(0).cwiseMin(1);
  return label;
}

std::vector<LabelName> readTable(const std::string& path) {
  recordRead(path);
  std::ifstream file(path);
  std::vector<LabelName> names;
  int number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    line = trimmed(line);
    if (line.empty() || line[0] == '#') continue;
    names.push_back(tableRow(path, number, line));
    if (names.size() > kMostNames) throw SceneError(path + ": too many rows; accepted: at most 65536");
  }
  return names;
}

std::vector<LabelName> readMap(const std::string& path) {
  const auto refuse = [&](const YAML::Mark& mark) {
    return SceneError(
        path + ":" + std::to_string(mark.line + 1) +
        ": not a map of label names; accepted: a map of numbers to names, such as 5: liver, or of names to numbers");
  };
  try {
    const YAML::Node map = YAML::LoadFile(path);
    if (!map.IsMap()) throw refuse(map.Mark());
    std::vector<LabelName> names;
    for (const auto& entry : map) {
      if (!entry.first.IsScalar() || !entry.second.IsScalar()) throw refuse(entry.first.Mark());
      LabelName label;
      if (parseInteger(entry.first.Scalar(), label.value))
        label.name = entry.second.Scalar();
      else if (parseInteger(entry.second.Scalar(), label.value))
        label.name = entry.first.Scalar();
      else
        throw refuse(entry.first.Mark());
      names.push_back(label);
      if (names.size() > kMostNames) throw SceneError(path + ": too many names; accepted: at most 65536");
    }
    return names;
  } catch (const YAML::Exception& error) {
    throw SceneError(path + ":" + std::to_string(error.mark.line + 1) + ": " + error.msg);
  }
}

}  // namespace

std::vector<LabelName> readLabelNames(const std::string& path) {
  if (fileBytes(path) > kMostTableBytes)
    throw SceneError(path + ": too large for a table of names of labels; accepted: at most 1 MiB");
  const std::string name = lower(path);
  if (endsWith(name, ".yaml") || endsWith(name, ".yml")) return readMap(path);
  if (endsWith(name, ".txt") || endsWith(name, ".label")) return readTable(path);
  throw SceneError(
      path +
      ": unknown format for names of labels; accepted: an ITK-SNAP table (.txt, .label) or a YAML map (.yaml, .yml)");
}

}  // namespace viscera
