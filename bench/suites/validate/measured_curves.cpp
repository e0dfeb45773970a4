// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/suites/validate/measured_curves.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "viscera/math/error.h"

namespace viscera::bench {

namespace {

constexpr double kPaPerKpa = 1000;
constexpr double kMostStress_kpa = 1e9;  // largest number that can be a stress
const std::string kStrainColumn = "strain", kMeanEnding = "_mean_kpa";

std::vector<std::string> fieldsOf(std::string line) {
  if (!line.empty() && line.back() == '\r') line.pop_back();
  std::vector<std::string> out;
  std::istringstream text(line + ",");
  for (std::string field; std::getline(text, field, ',');) out.push_back(field);
  return out;
}

double numberOf(const std::string& field, const std::string& where, double least, double most) {
  size_t read = 0;
  double out = NAN;
  try {
    out = std::stod(field, &read);
  } catch (const std::exception&) {  // reported below
  }
  if (read != field.size() || !(out >= least && out <= most)) {
    std::ostringstream text;
    text << where << ": must be a number, " << least << " .. " << most << "; found '" << field.substr(0, 40) << "'";
    throw Error(text.str());
  }
  return out;
}

bool isMean(const std::string& column) {
  return column.size() > kMeanEnding.size() &&
         column.compare(column.size() - kMeanEnding.size(), kMeanEnding.size(), kMeanEnding) == 0;
}

}  // namespace

double interpolated(const std::vector<double>& xs, const std::vector<double>& ys, double x) {
  const auto above = std::clamp<std::ptrdiff_t>(std::upper_bound(xs.begin(), xs.end(), x) - xs.begin(), 1,
                                                static_cast<std::ptrdiff_t>(xs.size()) - 1);
  const auto i = static_cast<size_t>(above);
  return ys[i - 1] + (ys[i] - ys[i - 1]) * (x - xs[i - 1]) / (xs[i] - xs[i - 1]);
}

double MeasuredCurve::at(double at_strain) const {
  return interpolated(strain, stress_pa, at_strain);
}

std::vector<MeasuredCurve> readMeasuredCurves(const std::string& file, double most_strain) {
  std::ifstream in(file);
  std::string line;
  if (!in || !std::getline(in, line)) throw Error(file + ": cannot be read, or is empty");
  const std::vector<std::string> head = fieldsOf(line);
  if (head[0] != kStrainColumn) throw Error(file + ":1: the first column must be '" + kStrainColumn + "'");
  std::vector<MeasuredCurve> out;
  for (const std::string& column : head) {
    if (isMean(column)) out.push_back({column.substr(0, column.size() - kMeanEnding.size()), {}, {}});
  }
  if (out.empty()) throw Error(file + ":1: there must be columns NAME" + kMeanEnding);
  double last = -1;
  for (size_t number = 2; std::getline(in, line); ++number) {
    const std::string where = file + ":" + std::to_string(number);
    const std::vector<std::string> fields = fieldsOf(line);
    if (fields.size() != head.size())
      throw Error(where + ": must have " + std::to_string(head.size()) + " columns; found " +
                  std::to_string(fields.size()));
    const double strain = numberOf(fields[0], where + ": " + kStrainColumn, 0, 0.99);
    if (strain <= last) throw Error(where + ": " + kStrainColumn + ": must be larger than in the line before");
    last = strain;
    size_t curve = 0;
    for (size_t c = 1; c < head.size(); ++c) {
      if (!isMean(head[c])) continue;
      out[curve].strain.push_back(strain);
      out[curve++].stress_pa.push_back(kPaPerKpa *
                                       numberOf(fields[c], where + ": " + head[c], -kMostStress_kpa, kMostStress_kpa));
    }
  }
  if (out[0].strain.size() < 2 || out[0].strain[0] > 0 || last < most_strain) {
    std::ostringstream text;
    text << file << ": strain: must cover at least 0 .. " << most_strain;
    throw Error(text.str());
  }
  return out;
}

}  // namespace viscera::bench
