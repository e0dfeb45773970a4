// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <iomanip>
#include <string>

#include "math/number_text.h"

namespace viscera {

/// Formats a number with a fixed number of decimals.
inline std::string rounded(double value, int digits) {
  TextOut out;
  out << std::fixed << std::setprecision(digits) << value;
  return out.str();
}

/// Formats a length in millimetres, without the unit. @param length_m  [m]
inline std::string millimetres(double length_m) {
  return rounded(1e3 * length_m, 2);
}

}  // namespace viscera
