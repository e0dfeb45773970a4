// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/math/types.h"

namespace viscera {

/// Reaction force and torque on a stylus, tissue frame, acting at the tip.
struct Reaction {
  Vector3d force_n = Vector3d::Zero();
  Vector3d torque_nm = Vector3d::Zero();
  bool saturated = false;
};

/// Saturates a force and limits its slew from one tick to the next (physics.md 5).
class ForceLimiter {
 public:
  ForceLimiter(double max_force_n, double max_rate_n_per_s);
  Reaction limit(const Reaction& raw, double tick_s);
  void reset() { last_ = Reaction{}; }

 private:
  double max_force_n_, max_rate_n_per_s_;
  Reaction last_;
};

}  // namespace viscera
