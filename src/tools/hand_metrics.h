// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <vector>

#include "viscera/math/types.h"

namespace viscera {

// Measures of a hand's motion and force, by the definitions that the field has for them (docs/replay.md).

/// What a hand did at even times.
struct HandTrack {
  double rate_hz = 0;
  std::vector<bool> tracked;       ///< the places of its tip are known
  std::vector<Vector3d> places_m;  ///< of its tip
  std::vector<Vector3d> forces_n;  ///< on it, as the tissue's, not limited
};

struct HandMetrics {
  double time_s = 0;    ///< in which it was tracked
  double path_m = 0;    ///< length of the way of its tip
  double economy = 0;   ///< straight from its first place to its last, over that; 0: it did not move
  double sparc = 0;     ///< spectralArcLength() of its speed
  double log_jerk = 0;  ///< logDimensionlessJerk() of its speed
  double peak_force_n = 0;
  double mean_force_n = 0;   ///< while there was any
  double force_time_ns = 0;  ///< its integral over time
  double force_volume_n3 =
      0;  ///< of the ellipsoid whose half axes are the standard deviations of the force, while there was any
};
HandMetrics metricsOf(const HandTrack& track);

/// The same but for smoothness, as it goes on: in a memory that does not grow.
class HandTally {
 public:
  explicit HandTally(double rate_hz) : rate_hz_(rate_hz) {}
  void addPlace(bool tracked, const Vector3d& place_m);
  void addForce(const Vector3d& force_n);
  HandMetrics metrics() const;

 private:
  double rate_hz_;
  HandMetrics sums_;
  std::optional<Vector3d> first_m_, last_m_, before_m_;  ///< tracked places; of the tick before, if it was tracked
  double forces_ = 0;                                    ///< how many
  Vector3d force_sum_ = Vector3d::Zero();
  Matrix3d square_sum_ = Matrix3d::Zero();
};

/// SPARC, the spectral arc length of a speed: how smooth a motion is; about -1.4 for one stroke, less for more. Padding
/// 4, frequencies to 10 Hz, amplitudes above 0.05. 0: nothing moved.
double spectralArcLength(const std::vector<double>& speeds, double rate_hz);
/// Less than 0, the more so the less smooth it is; 0: nothing moved.
double dimensionlessJerk(const std::vector<double>& speeds, double rate_hz);
/// -ln of its size; 0: nothing moved.
double logDimensionlessJerk(const std::vector<double>& speeds, double rate_hz);

}  // namespace viscera
