// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <vector>

#include "viscera/haptics/passivity.h"

namespace viscera {

/// Round trip of a device, estimated from how its motion follows the forces that were sent. Some round trips are
/// compared: for each, changes of velocity from pose to pose are fitted, by least squares, as what the forces of so
/// long ago make of an unknown mass, and as a hand's stiffness and damping,
///
///     dv = (1/m) integral of f dt + c1 x dt + c2 dx,   all without what is slower than some 10 ms
///
/// A round trip whose fit leaves more than another's is none. What was told holds until a longer one fits better.
class DelayEstimate {
 public:
  /// @param told_s     what is known of the round trip [s]
  /// @param longest_s  that may be, without evidence; one that is told may be longer [s]
  DelayEstimate(double told_s, double longest_s);

  /// A pose. @param at_m  of the hand   @param told_s  grows from call to call   @param sent  forces up to now
  void heard(const Vector3d& at_m, double told_s, const SentForces& sent);
  /// Motion goes on elsewhere: another hand, or a gap.
  void leave() { poses_ = 0; }

  double likely_s() const { return likely_s_; }    ///< what was told, or a longer one that fits better
  double longest_s() const { return longest_s_; }  ///< that is not excluded, at least likely_s()

 private:
  /// Signals of one moment, each with its slow part.
  struct Fast {
    Vector3d slow = Vector3d::Zero(), now = Vector3d::Zero();
    void add(const Vector3d& value, double gain);
  };
  /// Sums of a fit.
  struct Fit {
    double round_trip_s = 0;
    Fast pushed;                            ///< by forces, times mass
    double aa = 0, ab = 0, ac = 0, ay = 0;  ///< of pushed with itself, place, way, change of velocity
    double left = 1, per_mass = 0;          ///< share of the change that is left over; 1/m
  };
  struct Heard {
    Vector3d at_m = Vector3d::Zero();
    double time_s = 0;
  };
  bool pushed(const SentForces& sent, double gain);
  void sum();
  void solve(Fit& fit) const;
  void judge(double between_s);

  const double told_s_, unknown_s_;
  double likely_s_, longest_s_;
  std::vector<Fit> fits_;      ///< the first is the one that was told
  std::array<Heard, 3> last_;  ///< the newest is the last one
  int poses_ = 0;
  Fast change_, place_, way_;
  double bb_ = 0, bc_ = 0, cc_ = 0, by_ = 0, cy_ = 0, yy_ = 0;
};

}  // namespace viscera
