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

/// Additional forces of coagulated springs compared to fresh ones, as impulses after each substep: implicit Euler of
/// these forces alone, which is stable with any substep (docs/lessons/instruments.md, Shrinking and stiffening).
class BurntSprings {
 public:
  static constexpr double kStiffened = 3;  ///< stiffness over the fresh one when fully coagulated
  static constexpr double kShrunk = 0.15;  ///< share of the length lost when fully coagulated

  /// @param model  must outlive it
  explicit BurntSprings(const Model& model);

  /// Finds the coagulated springs, and how far each is coagulated.
  void find(const HeatField& heat, const CutSprings& cuts);
  bool empty() const { return springs_.empty(); }
  /// Applies the impulses of the last substep. @returns  work done on the tissue [J]
  double pull(TissuePort& port, double dt_s);

 private:
  struct Spring {
    uint32_t a = 0, b = 0;  ///< indices into slots_
    double rest_length_m = 0;
    double more_n_per_m = 0;            ///< stiffness in addition to the fresh one
    double tension_n = 0;               ///< tension at its rest length
    Vector3d along = Vector3d::Zero();  ///< unit vector from a to b in the substep
    double across_n_per_m = 0;
  };
  void multiply(double dt_s, const std::vector<Vector3d>& by, std::vector<Vector3d>& out) const;

  std::vector<Vector3f> rest_m_;      ///< [slots of the model]
  std::vector<double> inverse_mass_;  ///< [slots of the model] 1/kg; 0 if fixed
  std::vector<uint32_t> position_;    ///< [slots of the model] index into slots_, valid for those in it
  std::vector<uint32_t> slots_;       ///< slots of the nodes at their ends
  std::vector<Spring> springs_;
  // data of the substep
  std::vector<Vector3f> u_, v_;
  std::vector<Vector3d> dv_, residual_, direction_, product_;
};

}  // namespace viscera
