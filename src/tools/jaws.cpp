// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/tools/jaws.h"

#include <algorithm>

#include "math/archive.h"
#include "model/scene/tool_kinds.h"

namespace viscera {

namespace {

constexpr double kRounding = 1e-9;  // rounding of the sum over the ticks of a closing
// Jaws release when they open this far beyond the tissue: more than a user's tremor.
constexpr double kOpensAgain_rad = 0.02;

double closedBy(const Jaws& jaws, double opening_rad) {
  return std::clamp((jaws.open_rad - opening_rad) / (jaws.open_rad - jaws.closed_rad), 0.0, 1.0);
}

}  // namespace

double Gripper::openingNow(const Jaws& jaws) const {
  return std::max(openingOf(jaws, closed_), met_rad_);
}

void Gripper::letGo() {
  holds_ = false;
  met_rad_ = press_nm_ = 0;
  slid_before_m_ = slid_m_ = Vector3d::Zero();
}

void Gripper::advance(const Jaws& jaws, bool grips, float angle_rad, bool appears, double tick_s,
                      const std::function<std::optional<Between>(double)>& feel, StylusMotion& motion) {
  const bool is_driven = angle_rad >= 0;
  const double wanted = is_driven ? closedBy(jaws, angle_rad) : 1;
  if (is_driven && appears) closed_ = wanted;
  slid_before_m_ = slid_m_;
  const double before = closed_;
  motion.opens_from_rad = openingNow(jaws);
  const double reached = before + tick_s / jaws.closing_s + kRounding;
  follows_ = is_driven && (follows_ || wanted <= reached);
  closed_ = follows_ || wanted <= reached ? wanted : reached - kRounding;
  const bool closes = closed_ > before;
  if (closes && !closing_) mouth_rad_ = motion.opens_from_rad;
  closing_ = closes;
  motion.mouth_rad = static_cast<float>(mouth_rad_);
  if (grips) {
    const bool slid_out = slid_m_.norm() > jaws.length_m;
    motion.hold_begins = false;
    if (holds_ && (slid_out || openingOf(jaws, closed_) > met_rad_ + kOpensAgain_rad)) {
      motion.hold_ended = motion.mode;
      letGo();
    } else if (!holds_ && closes) {
      const std::optional<Between> found = feel ? feel(motion.opens_from_rad) : Between{motion.opens_from_rad, 0};
      const double asked_rad = openingOf(jaws, closed_);
      if (found && asked_rad <= std::max(found->meets_rad, jaws.closed_rad)) {
        motion.hold_begins = holds_ = true;
        met_rad_ = std::clamp(found->meets_rad, asked_rad, motion.opens_from_rad);
        press_nm_ = found->press_nm;
        taken_at_m_ = motion.from.position_m;
      }
    }
  }
  motion.opens_to_rad = openingNow(jaws);
}

/// Computes the slip from the secant stiffness: the tissue keeps the stretch that it had at the rated force. While the
/// tool moves on against the force, the held tissue stays behind by the same distance.
void Gripper::pulled(const StylusMotion& motion, const Vector3d& force_n, double rated_n) {
  const double pull_n = force_n.norm();
  if (!holds_ || !(pull_n > rated_n)) return;
  const Vector3d along = force_n / pull_n, held_m = motion.to.position_m + slid_m(motion);
  const double stretch_m = std::max(0.0, (taken_at_m_ - held_m).dot(along));
  const double goes_on_m = std::max(0.0, (motion.from.position_m - motion.to.position_m).dot(along));
  const double slides_m = (1 - rated_n / pull_n) * stretch_m + goes_on_m;
  slid_m_ += motion.to.orientation.conjugate() * (slides_m * along);
}

StylusMotion Gripper::ofHeld(const StylusMotion& motion) const {
  StylusMotion out = motion;
  out.from.position_m += motion.from.orientation * slid_before_m_;
  out.to.position_m += motion.to.orientation * slid_m_;
  out.slid_from_m = slid_before_m_;
  out.slid_to_m = slid_m_;
  return out;
}

double Gripper::moment_nm(const Jaws& jaws) const {
  if (!holds_ || met_rad_ == 0) return 0;
  return press_nm_ * std::max(0.0, met_rad_ - openingOf(jaws, closed_)) / met_rad_;
}

void Gripper::persist(Archive& archive) {
  for (bool* flag : {&follows_, &closing_, &holds_}) archive.value(*flag);
  for (double* value : {&closed_, &mouth_rad_, &met_rad_, &press_nm_}) archive.value(*value);
  for (Vector3d* value : {&taken_at_m_, &slid_before_m_, &slid_m_}) archive.value(*value);
}

}  // namespace viscera
