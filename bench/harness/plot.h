// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

namespace viscera::bench {

struct Series {
  enum class Style { kLinesPoints, kLines, kPoints };
  std::string name;
  std::vector<double> x, y;  ///< [points]; a point that is not finite, or not positive on a log axis, is left out
  Style style = Style::kLinesPoints;
};

/// A diagram of curves, drawn by gnuplot.
struct Plot {
  std::string title, x_label, y_label;
  bool log_x = false, log_y = false;
  std::vector<Series> series;
  bool equal_axes = false;  ///< whether both axes have the same scale

  /// Returns whether there is a point to draw.
  bool hasPoints() const;
  /// Writes gnuplot commands that include the data. @param png  file that they draw
  void writeScript(std::ostream& out, const std::string& png) const;
};

enum class Drawn { kYes, kNoGnuplot, kFailed };
/// Runs `gnuplot script` in a folder, to which file names in the script are relative. Its messages go to stderr.
Drawn runGnuplot(const std::string& folder, const std::string& script);

}  // namespace viscera::bench
