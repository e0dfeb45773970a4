// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/tools/force_limiter.h"

#include <algorithm>

namespace viscera {

namespace {

/// The largest share of a vector's length that is allowed, at most all of it.
double share(double length, double allowed) {
  return length > allowed ? allowed / length : 1;
}

void shrink(Vector3d& vector, double most) {
  const double length = vector.norm();
  if (length > most) vector *= most / length;
}

}  // namespace

ForceLimits ForceLimits::of(const StylusConfig& stylus) {
  return {stylus.max_force_n, stylus.max_force_rate_n_per_s, stylus.max_torque_nm, stylus.max_torque_rate_nm_per_s};
}

Reaction ForceLimiter::limit(const Reaction& raw, double span_s, const ForceLimits& limits) {
  Reaction out = raw;
  if (!raw.force_n.allFinite() || !raw.torque_nm.allFinite()) {
    out = Reaction{};
    out.saturated = true;
    last_ = out;
    return out;
  }
  if (limits.force_n == 0) out.force_n.setZero();
  if (limits.torque_nm == 0) out.torque_nm.setZero();
  const double size =
      std::min(share(out.force_n.norm(), limits.force_n), share(out.torque_nm.norm(), limits.torque_nm));
  if (size < 1) {
    out.force_n *= size;
    out.torque_nm *= size;
    out.saturated = true;
  }
  const Vector3d force_change = out.force_n - last_.force_n, torque_change = out.torque_nm - last_.torque_nm;
  const double way = std::min(share(force_change.norm(), limits.force_rate_n_per_s * span_s),
                              share(torque_change.norm(), limits.torque_rate_nm_per_s * span_s));
  if (way < 1) {
    out.force_n = last_.force_n + way * force_change;
    out.torque_nm = last_.torque_nm + way * torque_change;
    out.saturated = true;
  }
  last_ = out;
  return out;
}

const Reaction& ForceLimiter::shrink(double most_force_n, double most_torque_nm) {
  viscera::shrink(last_.force_n, most_force_n);
  viscera::shrink(last_.torque_nm, most_torque_nm);
  return last_;
}

}  // namespace viscera
