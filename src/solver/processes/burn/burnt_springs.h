// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "solver/processes/burn/heat_field.h"
#include "solver/processes/port.h"
#include "viscera/math/types.h"
#include "viscera/model/model.h"

namespace viscera {

/// What coagulated springs pull beyond what they pulled fresh, as impulses after each substep: implicit Euler of these
/// forces alone, so that no substep is too long for them (docs/lessons/cautery.md 4).
class BurntSprings {
 public:
  static constexpr double kStiffened = 3;  ///< times, coagulated through
  static constexpr double kShrunk = 0.15;  ///< of a length, the same

  /// @param model  must outlive it
  explicit BurntSprings(const Model& model);

  /// Which there are now, and how far each is coagulated.
  void find(const HeatField& heat, const CutSprings& cuts);
  bool empty() const { return springs_.empty(); }
  /// Gives the impulses of a substep that was just made. @returns  work done on the tissue [J]
  double pull(TissuePort& port, double dt_s);

 private:
  struct Spring {
    uint32_t a = 0, b = 0;  ///< in slots_
    double rest_length_m = 0;
    double more_n_per_m = 0;            ///< stiffness beyond the fresh one
    double tension_n = 0;               ///< at its length at rest
    Vector3d along = Vector3d::Zero();  ///< of the substep: unit vector from a to b
    double across_n_per_m = 0;
  };
  void multiply(double dt_s, const std::vector<Vector3d>& by, std::vector<Vector3d>& out) const;

  std::vector<Vector3f> rest_m_;      ///< [slots of the model]
  std::vector<double> inverse_mass_;  ///< [slots of the model] 1/kg; 0 where fixed
  std::vector<uint32_t> place_;       ///< [slots of the model] in slots_, of those that are there
  std::vector<uint32_t> slots_;       ///< of the nodes at their ends
  std::vector<Spring> springs_;
  // of the substep
  std::vector<Vector3f> u_, v_;
  std::vector<Vector3d> dv_, residual_, way_, product_;
};

}  // namespace viscera
