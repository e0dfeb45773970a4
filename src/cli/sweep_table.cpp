// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/sweep_table.h"

#include <utility>

namespace viscera::cli {

namespace {

std::string csvCell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

bool endsWith(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

/// Units of names; the longest suffix first.
constexpr std::pair<const char*, const char*> kUnits[] = {{"_kg_per_m3", "kg/m3"},
                                                          {"_m_per_s2", "m/s2"},
                                                          {"_m_per_s", "m/s"},
                                                          {"_n_per_m", "N/m"},
                                                          {"_per_s", "1/s"},
                                                          {"_pa", "Pa"},
                                                          {"_hz", "Hz"},
                                                          {"_deg", "deg"},
                                                          {"_px", "px"},
                                                          {"_kg", "kg"},
                                                          {"_m", "m"},
                                                          {"_s", "s"},
                                                          {"_n", "N"},
                                                          {"_j", "J"}};

}  // namespace

std::string unitOf(const std::string& name) {
  for (const auto& [end, unit] : kUnits) {
    if (endsWith(name, end)) return unit;
  }
  return {};
}

std::string csvText(const SweepTable& table) {
  std::string names, units, out;
  const size_t runs = table.columns.empty() ? 0 : table.columns[0].cells.size();
  for (size_t c = 0; c < table.columns.size(); ++c) {
    names += (c ? "," : "") + csvCell(table.columns[c].name);
    units += (c ? "," : "") + csvCell(unitOf(table.columns[c].name));
  }
  for (size_t run = 0; run < runs; ++run) {
    for (size_t c = 0; c < table.columns.size(); ++c) out += (c ? "," : "") + csvCell(table.columns[c].cells[run]);
    out += '\n';
  }
  return names + '\n' + units + '\n' + out;
}

}  // namespace viscera::cli
