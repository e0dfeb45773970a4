// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace viscera::cli {

/// The runs of a sweep in lines and columns.
struct SweepTable {
  /// Which heading a column belongs under.
  enum class Of { kRun, kKeys, kMetrics };
  struct Column {
    std::string name;
    Of of;
    bool number;                     ///< every cell that is not empty is one
    std::vector<std::string> cells;  ///< [runs] empty: the run has none
  };
  std::vector<Column> columns;
};

/// Head line and a line per run (RFC 4180).
std::string csvText(const SweepTable& table);

/// The unit that a name ends with, as in max_speed_m_per_s: "m/s"; empty where it has none.
std::string unitOf(const std::string& name);

/// Is all of a text one number?
bool isNumber(const std::string& text);

/// Was this program built with HDF5?
bool hasHdf5();
/// Writes a dataset of [runs] per column: those of the run itself at the top, scene keys in the group "keys", metrics
/// in "metrics". Numbers are float64, NaN where a run has none; all else is text, UTF-8, of any length. Units are the
/// attribute "unit". @throws Error  it cannot be written, or there is no HDF5
void writeHdf5(const SweepTable& table, const std::string& path);

}  // namespace viscera::cli
