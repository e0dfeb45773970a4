// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace viscera {

/// Options of PD-Jacobi, on any backend (physics.md 2).
struct PdOptions {
  int iterations = 20;  ///< sweeps per substep
  bool accelerated = true;
  double spectral_radius = 0;  ///< given for tests; 0: the bound from lattice and substep
};

/// Returns a bound on the spectral radius of plain PD-Jacobi. Near a minimum the iteration is 1 - D^-1 H with the
/// majoriser D = m/dt^2 + K, K = sum of (k + c/dt), and m/dt^2 <= H <= m/dt^2 + 2 K. So |1 - D^-1 H| <= K/(m/dt^2 + K),
/// which is largest where K/m is. Cuts only lower it.
/// @param stiffness_rate_per_s2  max of (sum of k)/m   @param damping_rate_per_s  max of (sum of c)/m
inline double jacobiRadius(double stiffness_rate_per_s2, double damping_rate_per_s, double dt_s) {
  const double rate = stiffness_rate_per_s2 + damping_rate_per_s / dt_s;
  return rate / (1 / (dt_s * dt_s) + rate);
}

/// Returns the weights of Chebyshev's semi-iteration: 1, 2/(2 - rho^2), then 4/(4 - rho^2 w).
/// @param weight  of the previous iteration
inline double chebyshevWeight(int iteration, double weight, double rho) {
  if (iteration == 0) return 1;
  return iteration == 1 ? 2 / (2 - rho * rho) : 4 / (4 - rho * rho * weight);
}

}  // namespace viscera
