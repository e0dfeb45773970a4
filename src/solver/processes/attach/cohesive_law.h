// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>

namespace viscera {

/// Traction of connective tissue by its opening (docs/physics.md 17): k d up to the strength, then falling linearly to
/// zero at the opening at which the work per area is the toughness. Below the largest opening so far the traction is
/// proportional to the opening.
struct CohesiveLaw {
  double stiffness_n_per_m3 = 0, strength_pa = 0;
  double end_m = 0;  ///< opening at which the traction is zero

  /// Returns the law of a stiffness and a toughness. The strength is at most that at which a brittle fibre takes as
  /// much work.
  static CohesiveLaw of(double stiffness_n_per_m3, double strength_pa, double toughness_j_per_m2) {
    CohesiveLaw out;
    out.stiffness_n_per_m3 = stiffness_n_per_m3;
    out.strength_pa = std::min(strength_pa, std::sqrt(2 * toughness_j_per_m2 * stiffness_n_per_m3));
    out.end_m = 2 * toughness_j_per_m2 / out.strength_pa;
    return out;
  }
  /// Returns the law with a share of strength and toughness.
  CohesiveLaw weakened(double share) const { return {stiffness_n_per_m3, share * strength_pa, end_m}; }

  double onset_m() const { return strength_pa / stiffness_n_per_m3; }  ///< opening at the strength
  /// Returns the traction over the opening after a largest opening [N/m3].
  double secant(double largest_m) const {
    if (largest_m >= end_m || strength_pa <= 0) return 0;
    if (largest_m <= onset_m()) return stiffness_n_per_m3;
    return tractionAt(largest_m) / largest_m;
  }
  /// Returns the work per area that is lost up to a largest opening [J/m2].
  double spent(double largest_m) const {
    if (largest_m <= onset_m()) return 0;
    const double to_m = std::min(largest_m, end_m);
    return 0.5 * (to_m * strength_pa - onset_m() * tractionAt(to_m));
  }

 private:
  /// Returns the traction beyond the onset.
  double tractionAt(double largest_m) const {
    return end_m > onset_m() ? strength_pa * (end_m - largest_m) / (end_m - onset_m()) : 0;
  }
};

}  // namespace viscera
