// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>

#include "solver/processes/suture/chain/chain_points.h"

namespace viscera {

/// How a point runs along a chain in a substep: between stops, and rubbing by a limit over what it slid.
struct ChainRun {
  static constexpr double kFar = std::numeric_limits<double>::infinity();
  double low = -kFar, high = kFar;  ///< of s, its place on the chain [links]
  double slid_m = 0;                ///< by the chain in this substep, that s has followed
  bool on_needle = false;           ///< of a chain that a needle is on: beside its tail it cannot give way
  ChainTurn turn;

  /// Another point is there, or, where that runs too, may come as far as their middle.
  void stopAt(double other, double apart, bool runs, double s);
  /// A new stiffness of friction. @param along  what it gave, times dt   @param limit  of that   @param off_m  along
  /// @returns whether it must be solved again
  bool rub(const ChainShape& shape, double along, double limit, double off_m, double mass_kg, double s,
           double& rub_kg) const;
  /// s goes where the chain has slid to. @param off_m  along   @param out  an end of the chain has passed
  /// @returns whether something stops it
  bool follow(const ChainShape& shape, double off_m, double& s, bool& out);
};

/// What does not slip holds.
inline bool slips(double rub_kg, double mass_kg) {
  return rub_kg < std::min(mass_kg, kRigidMass_kg);
}
inline double orRigid(double stiffness_kg, double mass_kg) {
  return stiffness_kg < mass_kg ? stiffness_kg : kRigidMass_kg;
}

}  // namespace viscera
