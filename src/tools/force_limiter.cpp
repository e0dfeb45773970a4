// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/tools/force_limiter.h"
#include "viscera/model/scene/stylus_config.h"

namespace viscera {

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
  const double size = shareWithin(out.force_n, out.torque_nm, limits.force_n, limits.torque_nm);
  if (size < 1) {
    out.force_n *= size;
    out.torque_nm *= size;
    out.saturated = true;
  }
  const Vector3d force_change = out.force_n - last_.force_n, torque_change = out.torque_nm - last_.torque_nm;
  const double scale = shareWithin(force_change, torque_change, limits.force_rate_n_per_s * span_s,
                                   limits.torque_rate_nm_per_s * span_s);
  if (scale < 1) {
    out.force_n = last_.force_n + scale * force_change;
    out.torque_nm = last_.torque_nm + scale * torque_change;
    out.saturated = true;
  }
  last_ = out;
  return out;
}

const Reaction& ForceLimiter::shrink(double most_force_n, double most_torque_nm) {
  last_.force_n *= shareWithin(last_.force_n.norm(), most_force_n);
  last_.torque_nm *= shareWithin(last_.torque_nm.norm(), most_torque_nm);
  return last_;
}

}  // namespace viscera
