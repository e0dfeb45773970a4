// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Contacts of a session's tools, from which forces between ticks are computed.
#include <algorithm>

#include "model/scene/tool_kinds.h"
#include "solver/processes/blade/blades.h"
#include "solver/processes/stylus_pull.h"
#include "solver/processes/suture/suture_bodies.h"
#include "tools/shaft_meeting.h"
#include "viscera/session/session.h"

namespace viscera {

namespace {

/// Adds the force of a suture or a needle on its stylus.
void addSuture(const StylusPull& pull, TickContact& contact) {
  const NeedleHold& needle = pull.needle;
  contact.kind = needle.stiffness_n_per_m > 0 ? TickContact::Kind::kPierces : TickContact::Kind::kPulls;
  if (contact.kind == TickContact::Kind::kPulls) return;
  const double along_n = contact.reaction.force_n.dot(needle.along);
  contact.along = needle.along;
  contact.limit_n = needle.ahead_n - along_n;
  contact.back_n = needle.back_n + along_n;
  contact.stiffness_n_per_m = needle.stiffness_n_per_m;
}

}  // namespace

/// Returns the contact of the last measured tick.
TickContact Session::contactOf(size_t stylus, const Reaction& raw) const {
  const StylusMotion motion = posesOf(judged_).motions[stylus], before = posesOf(judged_ - 1).motions[stylus];
  TickContact out;
  out.anew = !before.present || before.mode != motion.mode;
  out.from_m = motion.from.position_m;
  out.to_m = motion.to.position_m;
  const bool feels = motion.feels_m > 0 && !kindOf(motion.mode).does(kHolds);  // a grip acts, its shaft may not yet
  const bool acts = motion.present && !feels && raw.force_n.allFinite() && raw.torque_nm.allFinite();
  if (!acts || (stats_.touched[stylus] + stats_.grabbed[stylus] == 0 && !shafts_->touch())) return out;
  out.reaction = raw;
  const StylusPull& pull = solver_->pull(static_cast<uint32_t>(stylus));
  if (pull.nodes > 0 && pull.nodes == stats_.grabbed[stylus]) {
    addSuture(pull, out);
    return out;
  }
  out.kind = kindOf(motion.mode).does(kHolds) ? TickContact::Kind::kHolds : TickContact::Kind::kPushes;
  const double limit_n =
      kindOf(motion.mode).does(kCuts) ? bladeWork(*solver_, static_cast<uint32_t>(stylus)).limit_n : 0;
  if (limit_n > 0) out.limit_n = std::max(limit_n, raw.force_n.norm());
  return out;
}

/// Finds which styluses that may be inside tissue were not. Waits for this tick's measurements, so that the result, and
/// with it the state, does not depend on their latency.
void Session::detectInside(Frame& frame) {
  for (size_t s = 0; s < limiters_.size(); ++s) {
    if (!(request_.motions[s].feels_m > 0)) continue;
    frame.inside[s] = frame.health.recovering || frame.stats.touched[s] > 0;
    if (!frame.inside[s]) tools_.foundOutside(s);
  }
}

}  // namespace viscera
