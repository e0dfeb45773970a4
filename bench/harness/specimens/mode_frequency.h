// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace viscera::bench {

/// Returns the frequency of an undamped mode from its amplitude q, sampled every `stride` substeps of leapfrog.
/// Leapfrog advances the phase by theta per substep with sin(theta/2) = Omega dt/2, so q(n+1) + q(n-1) = 2 cos(stride
/// theta) q(n). This is fitted and solved for Omega [rad/s], which removes the error of time integration.
/// @param q  [samples], at least 3   @param stride  stride * theta < pi
inline double modeFrequency(const std::vector<double>& q, int stride, double dt_s) {
  double neighbors = 0, here = 0;
  for (size_t n = 1; n + 1 < q.size(); ++n) {
    neighbors += q[n] * (q[n - 1] + q[n + 1]);
    here += 2 * q[n] * q[n];
  }
  const double theta = std::acos(std::clamp(neighbors / here, -1.0, 1.0)) / stride;
  return 2 * std::sin(theta / 2) / dt_s;
}

/// Returns the phase by which leapfrog advances a mode in one substep.
inline double phasePerSubstep(double omega, double dt_s) {
  return 2 * std::asin(omega * dt_s / 2);
}

}  // namespace viscera::bench
