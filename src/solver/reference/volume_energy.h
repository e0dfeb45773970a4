// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

namespace viscera {

// Energy of volume of a cell (physics.md 1), e = V / V0 - 1, bulk = lambda_V h^3 [J]. Positive bulk: quadratic near
// rest, linear beyond |e| = 1, so the pressure stays bounded however a cell is torn or inverted. Negative bulk (nu <
// 1/4): bulk/2 g^2 with g = (e + e^2) / (1 + e^2), the same near rest; bounded below, else a large expansion would gain
// more energy than the springs can take, and nothing for a cell turned inside out, else that would gain.

/// W(e) [J].
inline double volumeEnergy(double bulk_j, double e) {
  if (bulk_j < 0) {
    const double g = e > -1 ? (e + e * e) / (1 + e * e) : 0;
    return 0.5 * bulk_j * g * g;
  }
  return bulk_j * (std::abs(e) <= 1 ? 0.5 * e * e : std::abs(e) - 0.5);
}

/// p = dW/de [J]: the pressure is -p / h^3.
inline double volumeSlope(double bulk_j, double e) {
  if (bulk_j < 0) {
    const double q = 1 + e * e;
    return e > -1 ? bulk_j * (e + e * e) / q * (1 + 2 * e - e * e) / (q * q) : 0;
  }
  return bulk_j * std::clamp(e, -1.0, 1.0);
}

/// d2W/de2 [J].
inline double volumeCurvature(double bulk_j, double e) {
  if (bulk_j < 0) {
    if (e <= -1) return 0;
    const double q = 1 + e * e, g = (e + e * e) / q, slope = (1 + 2 * e - e * e) / (q * q);
    const double bend = 2 * (1 - 3 * e - 3 * e * e + e * e * e) / (q * q * q);  // g''
    return bulk_j * (slope * slope + g * bend);
  }
  return std::abs(e) <= 1 ? bulk_j : 0;
}

}  // namespace viscera
