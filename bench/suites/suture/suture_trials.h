// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace viscera::bench {

/// Position of the tip of a 0.1 mm suture that is clamped at one end, relative to the free length.
struct TipTrial {
  double along = 0, across = 0;
};
/// Curvatures the suture by a force. @param load  P L^2 / EI of a force P across its tip
TipTrial bentByForce(double load, size_t nodes);
/// Curvatures the suture by a moment that should rotate the tip by `turns`. @returns rotation of the tip [turns]
double bentByMoment(double turns, size_t nodes);

/// A limp suture of 0.2 m that hangs between two points.
struct CatenaryTrial {
  double sag = 0, exact_sag = 0;          ///< [m]
  double tension = 0, exact_tension = 0;  ///< in the middle [N]
};
CatenaryTrial hungUp(double width_m, size_t nodes);

/// Draws a suture over a cylinder of 5 mm with friction 0.3.
/// @returns ratio of the tensions at the drawn and the held end, over exp(friction x angle)
double drawnOverCylinder(double angle_deg);

/// A suture of three hundred nodes, one end fixed.
struct PullTrial {
  double worst_link = 0;                       ///< relative error of a length
  double iterations = 0, most_iterations = 0;  ///< mean, and largest of a substep
  double tension = 0;                          ///< tension at the end, over the force
};
PullTrial pulledBy(double force_n);

/// A tangle in free flight, 2 s.
struct FlightTrial {
  double momentum = 0;  ///< change of the sum of m |v|
  double angular = 0;   ///< change of the sum of |x| m |v| across
  double worst_link = 0;
};
FlightTrial thrown();

/// First mode of a clamped suture.
struct ModeTrial {
  double hz = 0, exact_hz = 0, damping = 0, expected_damping = 0;  ///< ratios: omega damping_s / 2 is expected
};
ModeTrial plucked(double length_m);

/// Returns the CPU time of a substep with one iteration [us].
double substepCost_us(size_t nodes);

/// A suture with one end fixed; a user of 20 N moves the other end at up to 1 m/s, over ground and a cylinder.
struct StressTrial {
  double substeps = 0, bad = 0, worst_link = 0;  ///< bad: substeps with a link off by more than 1e-3
  double iterations = 0, most_iterations = 0, substep_us = 0;
  double nonfinite = 0, deepest_m = 0, most_force_n = 0;
  double rest_speed_m_per_s = 0;  ///< speed 4 s after the user has stopped [m/s]
};
StressTrial drawnAbout(double seconds, double bending_share);

}  // namespace viscera::bench
