// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/plot.h"

#include <errno.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <ostream>
#include <set>
#include <sstream>

namespace viscera::bench {

namespace {

constexpr int kWidth_px = 900, kHeight_px = 600;
constexpr size_t kColours = 8, kPointTypes = 13;
constexpr size_t kFewValues = 8;  ///< number of values up to which a log axis is labelled with them

std::string quoted(const std::string& text) {
  std::string out = "'";
  for (char c : text) out += c == '\'' ? std::string("''") : std::string(1, c == '\n' ? ' ' : c);
  return out + "'";
}

/// Returns colour, dashes and point type that distinguish curve `index` from the others: gnuplot has 8 colours.
std::string styleOf(Series::Style style, size_t index) {
  const std::string number = std::to_string(index % kPointTypes + 1), dashes = std::to_string(index / kColours + 1);
  const std::string line = " lt " + std::to_string(index % kColours + 1) + " lw 2 dt " + dashes,
                    point = " pt " + number;
  if (style == Series::Style::kLines) return "lines" + line;
  if (style == Series::Style::kPoints) return "points lt " + std::to_string(index % kColours + 1) + point + " ps 1.5";
  return "linespoints" + line + point;
}

bool isDrawn(const Plot& plot, double x, double y) {
  return std::isfinite(x) && std::isfinite(y) && (!plot.log_x || x > 0) && (!plot.log_y || y > 0);
}

size_t pointsOf(const Plot& plot, const Series& series) {
  size_t count = 0;
  for (size_t i = 0; i < std::min(series.x.size(), series.y.size()); ++i) {
    count += isDrawn(plot, series.x[i], series.y[i]);
  }
  return count;
}

/// Returns whether a number is short enough for a label of an axis, such as 0.75 or 10000.
bool isShortNumber(double value) {
  constexpr size_t kLongest = 6;
  std::ostringstream text;
  text << value;
  return text.str().size() <= kLongest;
}

/// Returns ticks of a log axis at the points; empty if there are too many points or they are measured values.
std::string ticksOf(const Plot& plot) {
  std::set<double> values;
  for (const Series& s : plot.series) {
    for (size_t i = 0; i < std::min(s.x.size(), s.y.size()); ++i) {
      if (isDrawn(plot, s.x[i], s.y[i])) values.insert(s.x[i]);
    }
  }
  if (values.size() > kFewValues || !std::all_of(values.begin(), values.end(), isShortNumber)) return "";
  std::ostringstream out;
  for (double value : values) out << (out.tellp() > 0 ? ", " : "set xtics (") << value;
  return values.empty() ? "" : out.str() + ")\n";
}

}  // namespace

bool Plot::hasPoints() const {
  return std::any_of(series.begin(), series.end(), [&](const Series& s) { return pointsOf(*this, s) > 0; });
}

void Plot::writeScript(std::ostream& out, const std::string& png) const {
  out.precision(9);
  out << "set terminal pngcairo noenhanced size " << kWidth_px << ',' << kHeight_px << "\nset output " << quoted(png)
      << "\nset title " << quoted(title) << "\nset xlabel " << quoted(x_label) << "\nset ylabel " << quoted(y_label)
      << "\nset grid\nset key outside right\n";
  if (equal_axes) out << "set size ratio -1\n";
  if (log_x) out << "set logscale x\nset format x '%g'\n" << ticksOf(*this);
  if (log_y) out << "set logscale y\nset format y '%g'\n";
  std::string curves;
  for (size_t s = 0; s < series.size(); ++s) {
    if (pointsOf(*this, series[s]) == 0) continue;  // gnuplot fails on an empty curve
    const std::string block = "$series" + std::to_string(s);
    out << block << " << END_OF_SERIES\n";
    for (size_t i = 0; i < std::min(series[s].x.size(), series[s].y.size()); ++i) {
      if (isDrawn(*this, series[s].x[i], series[s].y[i])) out << series[s].x[i] << ' ' << series[s].y[i] << '\n';
    }
    out << "END_OF_SERIES\n";
    curves += (curves.empty() ? "" : ", \\\n  ") + block + " with " + styleOf(series[s].style, s) + " title " +
              quoted(series[s].name);
  }
  if (!curves.empty()) out << "plot " << curves << '\n';
}

Drawn runGnuplot(const std::string& folder, const std::string& script) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  std::string name = "gnuplot", argument = script;
  char* arguments[] = {name.data(), argument.data(), nullptr};
  pid_t child = 0;
  const int error = posix_spawnp(&child, "gnuplot", &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) return error == ENOENT ? Drawn::kNoGnuplot : Drawn::kFailed;
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return Drawn::kFailed;
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? Drawn::kYes : Drawn::kFailed;
}

}  // namespace viscera::bench
