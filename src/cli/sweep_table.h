// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace viscera::cli {

/// The results of a sweep as a table.
struct SweepTable {
  struct Column {
    std::string name;
    std::vector<std::string> cells;  ///< [runs] values; empty: the run has none
  };
  std::vector<Column> columns;
};

/// Returns a line of names, a line of units, which may be empty, and a line per run (RFC 4180).
std::string csvText(const SweepTable& table);

/// Returns the unit at the end of a name: "m/s" for max_speed_m_per_s; empty if there is none.
std::string unitOf(const std::string& name);

}  // namespace viscera::cli
