// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace viscera::bench {

/// Measured engineering stress of a material in compression.
struct MeasuredCurve {
  std::string name;
  std::vector<double> strain;     ///< ascending
  std::vector<double> stress_pa;  ///< [strain]
  double at(double strain) const;
};

/// Reads a table of comma-separated values: its first column is `strain`, and every column NAME_mean_kpa is a material.
/// @param most_strain  strain that it must reach, from 0   @throws Error  names file, line and column
std::vector<MeasuredCurve> readMeasuredCurves(const std::string& file, double most_strain);

/// Interpolates between known points of ascending x. @param x  within their range
double interpolated(const std::vector<double>& xs, const std::vector<double>& ys, double x);

}  // namespace viscera::bench
