// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/tools/force_limiter.h"

namespace viscera {

ForceLimiter::ForceLimiter(double max_force_n, double max_rate_n_per_s)
    : max_force_n_(max_force_n), max_rate_n_per_s_(max_rate_n_per_s) {}

Reaction ForceLimiter::limit(const Reaction& raw, double tick_s) {
  Reaction out = raw;
  if (!raw.force_n.allFinite() || !raw.torque_nm.allFinite()) {  // the tissue is lost: no force, at once
    out = Reaction{};
    out.saturated = true;
    last_ = out;
    return out;
  }
  const double size = raw.force_n.norm();
  if (size > max_force_n_) {
    out.force_n *= max_force_n_ / size;
    out.torque_nm *= max_force_n_ / size;
    out.saturated = true;
  }
  const Vector3d change = out.force_n - last_.force_n;
  const double allowed = max_rate_n_per_s_ * tick_s;
  if (change.norm() > allowed) {
    const double share = allowed / change.norm();
    out.force_n = last_.force_n + share * change;
    out.torque_nm = last_.torque_nm + share * (out.torque_nm - last_.torque_nm);
    out.saturated = true;
  }
  last_ = out;
  return out;
}

}  // namespace viscera
