// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace viscera::bench {

/// Engineering stress of a material in compression, as measured.
struct MeasuredCurve {
  std::string name;
  std::vector<double> strain;     ///< ascending
  std::vector<double> stress_pa;  ///< [strain]
  double at(double strain) const;
};

/// A table of comma-separated values: its first column is `strain`, every column NAME_mean_kpa is a material.
/// @param most_strain  that it has to reach, from 0 on   @throws Error  with file, line and column
std::vector<MeasuredCurve> readMeasuredCurves(const std::string& file, double most_strain);

/// Between known points, of ascending x. @param x  within them
double interpolated(const std::vector<double>& xs, const std::vector<double>& ys, double x);

}  // namespace viscera::bench
