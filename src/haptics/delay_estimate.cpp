// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/haptics/delay_estimate.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace viscera {
namespace {

/// Poses that are closer are left out: an encoder's steps would drown their changes of velocity [s].
constexpr double kApart_s = 4e-3;
/// Slower changes are a hand's own [s].
constexpr double kFastTime_s = 0.01;
/// A push below this says nothing [N s].
constexpr double kTelling_n_s = 1e-5;
/// Moments that are remembered.
constexpr double kRemembered = 400;
/// Between round trips that are compared [s].
constexpr double kCompared_s = 2e-3;
/// What a fit leaves, of the best one's: more excludes its round trip. The best one must leave no more than a share.
constexpr double kExcluded = 1.15, kTrusted = 0.25;
/// Poses that come less often exclude nothing [s].
constexpr double kSwift_s = 6e-3;
/// Delays that differ by less are the same [s].
constexpr double kResolved_s = 1.5e-3;
/// What a fit leaves, of what the told one leaves: less makes it the likely one.
constexpr double kBetter = 0.9;
/// Two signals that are as alike as that are one.
constexpr double kSingular = 1e-9;

}  // namespace

DelayEstimate::DelayEstimate(double told_s, double longest_s)
    : told_s_(told_s), unknown_s_(std::max(told_s, longest_s)), likely_s_(told_s), longest_s_(unknown_s_) {
  fits_.push_back({});
  fits_[0].round_trip_s = told_s;
  const int steps = static_cast<int>(std::ceil(longest_s / kCompared_s - 1e-6));
  for (int i = 0; i <= steps; ++i) {
    fits_.push_back({});
    fits_.back().round_trip_s = std::min(i * kCompared_s, longest_s);
  }
}

void DelayEstimate::Fast::add(const Vector3d& value, double gain) {
  slow += gain * (value - slow);
  now = value - slow;
}

/// @returns whether any of it says something
bool DelayEstimate::pushed(const SentForces& sent, double gain) {
  bool telling = false;
  for (Fit& fit : fits_) {
    const double trip_s = fit.round_trip_s;
    const auto after = sent.meanSum(last_[1].time_s - trip_s, last_[2].time_s - trip_s);
    const auto before = sent.meanSum(last_[0].time_s - trip_s, last_[1].time_s - trip_s);
    fit.pushed.add(after && before ? Vector3d(*after - *before) : Vector3d(Vector3d::Zero()), gain);
    telling = telling || fit.pushed.now.norm() > kTelling_n_s;
  }
  return telling;
}

void DelayEstimate::heard(const Vector3d& at_m, double told_s, const SentForces& sent) {
  if (poses_ > 0 && told_s - last_[2].time_s < kApart_s) return;
  std::rotate(last_.begin(), last_.begin() + 1, last_.end());
  last_[2] = {at_m, told_s};
  if (++poses_ < 3) return;
  const double first_s = last_[1].time_s - last_[0].time_s, second_s = last_[2].time_s - last_[1].time_s;
  const double between_s = 0.5 * (first_s + second_s);
  const double gain = poses_ == 3 ? 1 : between_s / (between_s + kFastTime_s);
  change_.add((last_[2].at_m - last_[1].at_m) / second_s - (last_[1].at_m - last_[0].at_m) / first_s, gain);
  place_.add(last_[1].at_m, poses_ == 3 ? 1 : gain);
  way_.add(0.5 * (last_[2].at_m - last_[0].at_m), gain);
  if (!pushed(sent, gain)) return;
  place_.now *= between_s;
  sum();
  for (Fit& fit : fits_) solve(fit);
  judge(between_s);
}

void DelayEstimate::sum() {
  const double keeps = 1 - 1 / kRemembered;
  const auto add = [keeps](double& to, const Vector3d& a, const Vector3d& b) { to = keeps * to + a.dot(b); };
  const Vector3d &b = place_.now, &c = way_.now, &y = change_.now;
  add(bb_, b, b);
  add(bc_, b, c);
  add(cc_, c, c);
  add(by_, b, y);
  add(cy_, c, y);
  add(yy_, y, y);
  for (Fit& fit : fits_) {
    const Vector3d& a = fit.pushed.now;
    add(fit.aa, a, a);
    add(fit.ab, a, b);
    add(fit.ac, a, c);
    add(fit.ay, a, y);
  }
}

/// Normal equations of three unknowns.
void DelayEstimate::solve(Fit& fit) const {
  const Vector3d a(fit.aa, fit.ab, fit.ac), b(fit.ab, bb_, bc_), c(fit.ac, bc_, cc_), y(fit.ay, by_, cy_);
  const double size = a.dot(b.cross(c));
  fit.left = 1;
  fit.per_mass = 0;
  if (!(size > kSingular * fit.aa * bb_ * cc_)) return;
  const Vector3d of(y.dot(b.cross(c)), y.dot(c.cross(a)), y.dot(a.cross(b)));
  fit.per_mass = of.x() / size;
  if (yy_ > 0) fit.left = std::max(1 - of.dot(y) / (size * yy_), 0.0);
}

void DelayEstimate::judge(double between_s) {
  const Fit* best = nullptr;
  for (const Fit& fit : fits_)
    if (fit.per_mass > 0 && (!best || fit.left < best->left)) best = &fit;
  likely_s_ = told_s_;
  longest_s_ = unknown_s_;
  if (!best) return;
  const Fit& told = fits_[0];
  if (best->round_trip_s > told_s_ + kResolved_s && (!(told.per_mass > 0) || best->left < kBetter * told.left))
    likely_s_ = best->round_trip_s;
  if (best->left > kTrusted || between_s > kSwift_s) return;
  longest_s_ = likely_s_;
  for (const Fit& fit : fits_)
    if (fit.left <= kExcluded * best->left) longest_s_ = std::max(longest_s_, fit.round_trip_s);
}

}  // namespace viscera
