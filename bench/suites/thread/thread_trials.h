// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace viscera::bench {

/// A thread of 0.1 mm clamped at one end: where its tip comes to lie, of the free length.
struct TipTrial {
  double along = 0, across = 0;
};
/// @param load  P L^2 / EI of a force P across its tip
TipTrial bentByForce(double load, size_t nodes);
/// @returns turns of the tip under a moment that should turn it by so many
double bentByMoment(double turns, size_t nodes);

/// A limp thread of 0.2 m that hangs between two points.
struct CatenaryTrial {
  double sag = 0, exact_sag = 0;          ///< [m]
  double tension = 0, exact_tension = 0;  ///< in the middle [N]
};
CatenaryTrial hungUp(double width_m, size_t nodes);

/// A thread drawn over a cylinder of 5 mm, of friction 0.3. @returns tension where it is drawn over that where it is
/// held back, over exp(friction x angle)
double drawnOverCylinder(double angle_deg);

/// Three hundred nodes, one end held.
struct PullTrial {
  double worst_link = 0;                       ///< relative error of a length
  double iterations = 0, most_iterations = 0;  ///< mean; of a substep
  double tension = 0;                          ///< at the end, over the force
};
PullTrial pulledBy(double force_n);

/// A tangle in free flight, 2 s.
struct FlightTrial {
  double momentum = 0;  ///< change, of the sum of m |v|
  double angular = 0;   ///< change, of the sum of |x| m |v| across
  double worst_link = 0;
};
FlightTrial thrown();

/// First mode of a clamped thread.
struct ModeTrial {
  double hz = 0, exact_hz = 0, damping = 0, expected_damping = 0;  ///< ratios: omega damping_s / 2 is expected
};
ModeTrial plucked(double length_m);

/// CPU time of a substep that takes one iteration [us].
double substepCost_us(size_t nodes);

/// One end held, the other drawn about by a hand of 20 N at up to 1 m/s, over ground and a cylinder.
struct StressTrial {
  double substeps = 0, bad = 0, worst_link = 0;  ///< bad: substeps with a link off by more than 1e-3
  double iterations = 0, most_iterations = 0, substep_us = 0;
  double nonfinite = 0, deepest_m = 0, most_force_n = 0;
  double rest_speed_m_per_s = 0;  ///< 4 s after the hand has stopped
};
StressTrial drawnAbout(double seconds, double bending_share);

}  // namespace viscera::bench
