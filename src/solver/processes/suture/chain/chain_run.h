// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

#include "solver/processes/suture/chain/chain_points.h"

namespace viscera {

/// Motion of a point along a chain in a substep: between stops, with friction as the limit over the slip.
struct ChainRun {
  static constexpr double kFar = std::numeric_limits<double>::infinity();
  double low = -kFar, high = kFar;  ///< bounds of s, its position on the chain [links]
  double slid_m = 0;                ///< displacement along the chain in this substep that s has followed
  bool on_needle = false;           ///< the chain has a needle: next to the needle's tail it cannot yield
  ChainTurn turn;

  /// Stops it at another point or, where that moves too, at the middle between them.
  void stopAt(double other, double apart, bool runs, double s);
  /// Updates the stiffness of friction. @param along  its force times dt^2   @param limit  bound of that
  /// @param off_m  offset along
  /// @returns whether the system must be solved again
  bool rub(const ChainShape& shape, double along, double limit, double off_m, double mass_kg, double s,
           double& rub_kg) const;
  /// Moves s to where the chain has slid. @param off_m  offset along   @param out  set if an end of the chain has
  /// passed
  /// @returns whether something stops it
  bool follow(const ChainShape& shape, double off_m, double& s, bool& out);
};

/// Returns whether the friction slips; else it holds.
inline bool slips(double rub_kg, double mass_kg) {
  return rub_kg < std::min(mass_kg, kRigidMass_kg);
}
inline double orRigid(double stiffness_kg, double mass_kg) {
  return stiffness_kg < mass_kg ? stiffness_kg : kRigidMass_kg;
}

}  // namespace viscera
