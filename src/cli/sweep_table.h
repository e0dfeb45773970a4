// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace viscera::cli {

/// The runs of a sweep in lines and columns.
struct SweepTable {
  struct Column {
    std::string name;
    std::vector<std::string> cells;  ///< [runs] empty: the run has none
  };
  std::vector<Column> columns;
};

/// A line of names, a line of units, empty where there is none, and a line per run (RFC 4180).
std::string csvText(const SweepTable& table);

/// The unit that a name ends with, as in max_speed_m_per_s: "m/s"; empty where it has none.
std::string unitOf(const std::string& name);

}  // namespace viscera::cli
