// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "viscera/math/types.h"

namespace viscera {

// Metrics of a tool's motion and force, by the definitions of the field (docs/replay.md).

/// Positions of a tool's tip and forces on it at a constant rate.
struct ToolTrack {
  double rate_hz = 0;
  std::vector<bool> tracked;          ///< the position of its tip is known
  std::vector<Vector3d> positions_m;  ///< positions of its tip
  std::vector<Vector3d> forces_n;     ///< forces of the tissue on it, without limits
};

struct ToolMetrics {
  double time_s = 0;    ///< time for which it was tracked [s]
  double path_m = 0;    ///< length of the path of its tip [m]
  double economy = 0;   ///< distance from its first to its last position, over path_m; 0: it did not move
  double sparc = 0;     ///< spectralArcLength() of its speed
  double log_jerk = 0;  ///< logDimensionlessJerk() of its speed
  double peak_force_n = 0;
  double mean_force_n = 0;   ///< mean force [N], while there was any
  double force_time_ns = 0;  ///< integral of the force over time [N s]
  double force_volume_n3 =
      0;  ///< volume of the ellipsoid with the standard deviations of the force as half axes, while there was any [N3]
};
ToolMetrics metricsOf(const ToolTrack& track);

/// Incremental computation of the same metrics without smoothness, in constant memory.
class ToolTally {
 public:
  explicit ToolTally(double rate_hz) : rate_hz_(rate_hz) {}
  void addPosition(bool tracked, const Vector3d& position_m);
  void addForce(const Vector3d& force_n);
  ToolMetrics metrics() const;

 private:
  double rate_hz_;
  ToolMetrics sums_;
  /// Tracked positions; before_m_ of the previous tick, if it was tracked.
  std::optional<Vector3d> first_m_, last_m_, before_m_;
  double forces_ = 0;  ///< number of forces
  Vector3d force_sum_ = Vector3d::Zero();
  Matrix3d square_sum_ = Matrix3d::Zero();
};

/// Returns SPARC, the spectral arc length of a speed, a measure of smoothness: about -1.4 for one stroke, less for
/// more. Padding 4, frequencies to 10 Hz, amplitudes above 0.05. 0: nothing moved.
double spectralArcLength(const std::vector<double>& speeds, double rate_hz);
/// Returns the dimensionless jerk: below 0, and lower for less smooth motion; 0: nothing moved.
double dimensionlessJerk(const std::vector<double>& speeds, double rate_hz);
/// Returns -ln of its magnitude; 0: nothing moved.
double logDimensionlessJerk(const std::vector<double>& speeds, double rate_hz);

}  // namespace viscera
