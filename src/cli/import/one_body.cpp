// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/import/one_body.h"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <filesystem>

#include "math/number_text.h"
#include "model/scan/surface_net.h"
#include "viscera/math/error.h"

namespace viscera::cli {
namespace {

constexpr double kPlayableNu = 0.45;  ///< replaces 0.49 of wet tissue: half the substeps (docs/tissues.md)
constexpr size_t kMostParts = 64;     ///< most parts of a body, as in body_fields.h

/// Returns the text quoted for YAML.
std::string quoted(const std::string& text) {
  YAML::Emitter out;
  out << YAML::DoubleQuoted << text;
  return out.c_str();
}

std::string absolute(const std::string& path) {
  return quoted(std::filesystem::absolute(path).lexically_normal().string());
}

}  // namespace

std::string materialOf(const TissuePreset* tissue) {
  if (!tissue) return "young_modulus_pa: 10000, density_kg_per_m3: 1060";
  const std::string named = "tissue: " + std::string(tissue->name);
  if (tissue->poisson_ratio <= kPlayableNu) return named;
  TextOut nu;
  nu << kPlayableNu;
  return named + ", poisson_ratio: " + nu.str();
}

std::vector<bool> rigidLabels(const std::vector<LabelName>& names, const ImportOptions& options) {
  std::vector<bool> rigid(names.size(), false);
  for (const std::string& asked : options.rigid) {
    bool known = false;
    std::string accepted;
    for (size_t n = 1; n < names.size(); ++n) {
      const std::string value = std::to_string(names[n].value);
      accepted += (n > 1 ? ", " : "") + value + (names[n].name.empty() ? "" : " (" + names[n].name + ")");
      if (asked != value && asked != names[n].name) continue;
      known = rigid[n] = true;
    }
    if (!known) throw SceneError(options.scan + ": --rigid names unknown label '" + asked + "'; accepted: " + accepted);
  }
  return rigid;
}

std::string oneBodySource(const std::vector<LabelName>& names, const std::vector<bool>& there,
                          const std::vector<bool>& rigid, const ImportOptions& options) {
  if (names.size() - 1 > kMostParts)
    throw SceneError(options.scan + ": " + std::to_string(names.size() - 1) + " labels; --one-body accepts at most " +
                     std::to_string(kMostParts) + ". Choose fewer with --labels");
  const LabelOptions& of = options.labels;
  std::string out = "source: labels\n    scan:\n      file: " + absolute(options.scan) + "\n";
  for (size_t n = 0; n < of.labels.size(); ++n) out += (n ? ", " : "      labels: [") + quoted(of.labels[n]);
  if (!of.labels.empty()) out += "]\n";
  if (!of.names_file.empty()) out += "      names_file: " + absolute(of.names_file) + "\n";
  if (!of.axes.empty()) out += "      axes: " + quoted(of.axes) + "\n";
  if (!of.transform.empty()) out += "      transform: " + quoted(of.transform) + "\n";
  if (of.volume >= 0) out += "      volume: " + std::to_string(of.volume) + "\n";
  if (!of.series.empty()) out += "      series: " + quoted(of.series) + "\n";
  const std::vector<std::string> parts = partNames(names);
  bool any = false;
  for (size_t n = 1; n < parts.size(); ++n) {
    if (!there[n] || rigid[n]) continue;
    out += (any ? "" : std::string("    parts:\n")) + "      - {part: " + quoted(parts[n]) + ", " +
           materialOf(tissueOfLabel(names[n].name)) + "}\n";
    any = true;
  }
  out.pop_back();
  return out;
}

std::string heldParts(const std::vector<LabelName>& names, const std::vector<bool>& there,
                      const std::vector<bool>& rigid) {
  const std::vector<std::string> parts = partNames(names);
  std::string out;
  for (size_t n = 1; n < parts.size(); ++n)
    if (there[n] && rigid[n]) out += "      - {shape: part, part: " + quoted(parts[n]) + "}\n";
  return out;
}

}  // namespace viscera::cli
