// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace viscera {

using PlotPoints = std::vector<std::pair<double, double>>;

/// Returns a color of Okabe and Ito, distinct for seven neighbouring indices.
const char* plotColor(size_t index);
/// Returns a text for HTML or SVG, on one line: with &, <, > and quotes as entities.
std::string htmlText(const std::string& text);
/// Returns the beginning of an HTML page with our style, up to its body. @param title  as HTML
std::string pageHead(const std::string& title);

/// Axis of a plot: range of the data, and a label with its unit.
struct PlotAxis {
  double low = 0, high = 1;
  std::string label;
};
/// Returns the distance between the marks of an axis: 1, 2 or 5 times a power of ten, for three to eight marks.
double tickStep(double low, double high);
/// Returns an axis from 0 to a multiple of its step, with room for the largest value.
PlotAxis axisUpTo(double largest, const std::string& label);

/// Plot as SVG. Margins fit the labels, so that nothing is cut off.
class Plot {
 public:
  /// @param wide, high  size of the area of the data [px]
  Plot(PlotAxis x, PlotAxis y, double wide, double high)
      : x_(std::move(x)), y_(std::move(y)), wide_(wide), high_(high) {}
  /// @param dashes  pattern of SVG; empty: a solid line
  void addLine(const PlotPoints& points, const std::string& color, double width, const std::string& dashes = "");
  void addDot(double x, double y, const std::string& color, double radius_px);
  std::string svg() const;

 private:
  std::pair<double, double> at(double x, double y) const {
    return {(x - x_.low) / (x_.high - x_.low) * wide_, (y_.high - y) / (y_.high - y_.low) * high_};
  }

  const PlotAxis x_, y_;
  const double wide_, high_;
  std::string inside_;
};

}  // namespace viscera
