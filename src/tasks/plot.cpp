// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tasks/plot.h"

#include <algorithm>
#include <cmath>

#include "math/number_text.h"
#include "math/one_line.h"

namespace viscera {

namespace {

constexpr const char* kPageStyle =
    R"(body{font:15px/1.45 system-ui,sans-serif;margin:2em auto;padding:0 1em;max-width:60em}
h1{margin:0}.state{display:inline-block;padding:.2em .8em;border-radius:.3em;color:#fff;font-weight:600}
.passed{background:#18794e}.failed{background:#b42318}.waiting,.running{background:#777}
table{border-collapse:collapse;margin:.6em 0}td,th{border-bottom:1px solid #ddd;padding:.2em .8em;text-align:right}
td:first-child,th:first-child,.attempt td,.attempts td,.attempts th{text-align:left}.exceeded{background:#fde8e6}
code{color:#666;font-size:12px}figure>svg{max-width:100%;height:auto}
svg text{font:12px system-ui,sans-serif;fill:#444}figure{display:inline-block;margin:.5em 1em .5em 0}img{max-width:28em}
pre{white-space:pre-wrap;font:inherit}.small{color:#666;font-size:13px})";
constexpr size_t kMostPoints = 1500;  // points of a curve: more would not be visible
constexpr double kFewestTicks = 3;
constexpr double kDigit_px = 7.5;  // width of a digit, at most, in the font of the page
constexpr double kTop_px = 16, kRight_px = 36, kBottom_px = 48, kLabel_px = 24, kGap_px = 6;
constexpr const char *kAxisColor = "#999", *kGridColor = "#e4e4e4";

std::string px(double value) {
  return numberText(value, 5);
}

std::vector<double> ticksOf(const PlotAxis& axis) {
  const double step = tickStep(axis.low, axis.high);
  std::vector<double> out;
  for (double k = std::ceil(axis.low / step - 1e-9); k * step <= axis.high + 1e-9 * step; ++k)
    out.push_back(k == 0 ? 0.0 : k * step);
  return out;
}

std::string segment(double x1, double y1, double x2, double y2, const char* color) {
  return "<line x1='" + px(x1) + "' y1='" + px(y1) + "' x2='" + px(x2) + "' y2='" + px(y2) + "' stroke='" + color +
         "'/>";
}

std::string plotLabel(double x, double y, const std::string& text, const char* anchor, const std::string& more = "") {
  return "<text x='" + px(x) + "' y='" + px(y) + "' text-anchor='" + anchor + "'" + more + ">" + htmlText(text) +
         "</text>";
}

}  // namespace

const char* plotColor(size_t index) {
  constexpr const char* kColors[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"};
  return kColors[index % std::size(kColors)];
}

std::string htmlText(const std::string& text) {
  std::string out;
  for (const char c : oneLine(text)) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string pageHead(const std::string& title) {
  return "<!doctype html><html lang='en'><head><meta charset='utf-8'><title>" + title + "</title><style>" + kPageStyle +
         "</style></head><body>\n";
}

double tickStep(double low, double high) {
  const double largest = (high - low) / kFewestTicks;
  const double power = std::pow(10, std::floor(std::log10(largest)));
  for (const double factor : {5.0, 2.0})
    if (factor * power <= largest) return factor * power;
  return power;
}

PlotAxis axisUpTo(double largest, const std::string& label) {
  const double high = std::isfinite(largest) && largest > 0 ? largest : 1;
  const double step = tickStep(0, high);
  return {0, step * std::ceil(high / step - 1e-9), label};
}

void Plot::addLine(const PlotPoints& points, const std::string& color, double width, const std::string& dashes) {
  inside_ += "<polyline fill='none' stroke='" + color + "' stroke-width='" + px(width) + "'" +
             (dashes.empty() ? "" : " stroke-dasharray='" + dashes + "'") + " points='";
  const size_t every = std::max<size_t>(1, points.size() / kMostPoints);
  for (size_t i = 0; i < points.size(); i += every) {
    const auto [x, y] = at(points[i].first, points[i].second);
    inside_ += px(x) + "," + px(y) + " ";
  }
  inside_ += "'/>";
}

void Plot::addDot(double x, double y, const std::string& color, double radius_px) {
  const auto [cx, cy] = at(x, y);
  inside_ += "<circle cx='" + px(cx) + "' cy='" + px(cy) + "' r='" + px(radius_px) + "' fill='" + color + "'/>";
}

std::string Plot::svg() const {
  size_t digits = 1;
  for (const double tick : ticksOf(y_)) digits = std::max(digits, numberText(tick).size());
  const double left = kLabel_px + kDigit_px * static_cast<double>(digits) + kGap_px, low = kTop_px + high_;
  const double whole_wide = left + wide_ + kRight_px, whole_high = low + kBottom_px;
  std::string out;
  for (const double tick : ticksOf(x_)) {
    const double x = left + at(tick, y_.low).first;
    out += segment(x, kTop_px, x, low, kGridColor) + plotLabel(x, low + 16, numberText(tick), "middle");
  }
  for (const double tick : ticksOf(y_)) {
    const double y = kTop_px + at(x_.low, tick).second;
    out += segment(left, y, left + wide_, y, kGridColor) + plotLabel(left - kGap_px, y + 4, numberText(tick), "end");
  }
  out += segment(left, kTop_px, left, low, kAxisColor) + segment(left, low, left + wide_, low, kAxisColor);
  const std::string middle_y = px(kTop_px + high_ / 2), turn_x = "14";
  out += plotLabel(left + wide_ / 2, whole_high - 10, x_.label, "middle");
  out += plotLabel(14, kTop_px + high_ / 2, y_.label, "middle",
                   " transform='rotate(-90 " + turn_x + " " + middle_y + ")'");
  out += "<svg x='" + px(left) + "' y='" + px(kTop_px) + "' width='" + px(wide_) + "' height='" + px(high_) + "'>" +
         inside_ + "</svg>";
  return "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 " + px(whole_wide) + " " + px(whole_high) + "' width='" +
         px(whole_wide) + "' height='" + px(whole_high) + "'>" + out + "</svg>\n";
}

}  // namespace viscera
