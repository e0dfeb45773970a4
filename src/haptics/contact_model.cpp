// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/haptics/contact_model.h"

#include <algorithm>
#include <cmath>

#include "math/decompositions.h"

namespace viscera {
namespace {

using Kind = TickContact::Kind;

/// A displacement between ticks below this carries little information: noise of the device and motion of the tissue are
/// of this size [m].
constexpr double kTellingMove_m = 5e-5;
/// The direction of a force below this is not reliable [N].
constexpr double kLeastForce_n = 1e-9;
/// Time for which a surface is assumed to stay after the tip left it [s].
constexpr double kRemembered_s = 0.3;
/// Bounds of the learnt stiffness, relative to that of the tissue's constants: a thin layer on bone is stiffer than a
/// half space, a flap is softer.
constexpr double kSoftest = 0.3, kStiffest = 6;
/// Share of a blade's limit (and of a needle's along its shaft) above which a force says nothing about stiffness, since
/// the edge moves on.
constexpr double kYields = 0.9;
/// Initial stiffness of a needle along its shaft, relative to that across.
constexpr double kAlongShaft = 0.4;
/// Limit of a suture's force, relative to that of the tick: a slack suture is not known to be stiff.
constexpr double kMostPull = 2;

Vector3d directionOf(const Vector3d& v) {
  const double length = v.norm();
  return length > kLeastForce_n ? Vector3d(v / length) : Vector3d(Vector3d::Zero());
}

/// Returns the nearest symmetric matrix with eigenvalues within limits.
Matrix3d within(const Matrix3d& k, double least, double most) {
  const PrincipalAxes of = principalAxes(0.5 * (k + k.transpose()));
  const Vector3d values = of.values.cwiseMax(least).cwiseMin(most);
  return of.axes * values.asDiagonal() * of.axes.transpose();
}

/// Returns the projection onto a unit vector.
Matrix3d onto(const Vector3d& along) {
  return along * along.transpose();
}

bool yields(const TickContact& contact) {
  const Vector3d& force_n = contact.reaction.force_n;
  if (contact.kind != Kind::kPierces) return force_n.norm() > kYields * contact.limit_n;
  const double along_n = force_n.dot(contact.along);
  const double near_n = (1 - kYields) * (contact.limit_n + contact.back_n);
  return along_n < near_n - contact.limit_n || along_n > contact.back_n - near_n;
}

}  // namespace

/// Returns the stiffness along the normal [N/m]. Hertz: F = 4/3 E* sqrt(r) d^1.5, so dF/dd = 2 E* sqrt(r d),
/// E* = E / (1 - nu^2). For a sphere held by tissue: 24 pi mu (1 - nu) r / (5 - 6 nu) in an infinite solid, half of it
/// at a surface.
double ContactModel::stiffnessOf(double young_modulus_pa, const TickContact& contact) const {
  const double nu = tissue_.poisson_ratio, r = tissue_.tip_radius_m;
  if (contact.kind == Kind::kHolds) {
    constexpr double kPi = 3.14159265358979323846;
    const double mu = young_modulus_pa / (2 * (1 + nu));
    return 0.5 * 24 * kPi * mu * (1 - nu) * r / (5 - 6 * nu);
  }
  const double reduced = young_modulus_pa / (1 - nu * nu);
  const double size = reduced * std::sqrt(r);
  return 2 * size * std::cbrt(0.75 * contact.reaction.force_n.norm() / size);
}

/// Returns the initial stiffness. It is zero for a suture, since what it is attached to is not known.
Matrix3d ContactModel::first(const TickContact& contact) const {
  if (contact.kind == Kind::kPulls) return Matrix3d::Zero();
  if (contact.kind == Kind::kPierces)
    return contact.stiffness_n_per_m * (Matrix3d::Identity() - (1 - kAlongShaft) * onto(contact.along));
  const double k = stiffnessOf(tissue_.stiffest_pa, contact);
  if (contact.kind == Kind::kHolds) return k * Matrix3d::Identity();
  return k * onto(directionOf(contact.reaction.force_n));
}

/// Returns the stiffness updated with the last two ticks. Powell's symmetric update: of all symmetric K with
/// K dx = -dF, the one nearest to the previous K. A suture is updated along its force only, a needle that moves on only
/// across its shaft.
Matrix3d ContactModel::learnt(const TickContact& contact, const Vector3d& at_m) const {
  if (contact.kind != now_.kind) return first(contact);
  Matrix3d k = now_.stiffness, telling = Matrix3d::Identity();
  if (contact.kind == Kind::kPulls) {
    telling = onto(directionOf(contact.reaction.force_n));
    k = telling * k * telling;
  } else if (yields(contact)) {
    if (contact.kind != Kind::kPierces) return k;
    telling -= onto(contact.along);
  }
  const Vector3d dx = telling * (at_m - now_.at_m);
  const Vector3d miss = telling * (now_.force_n - contact.reaction.force_n) - k * dx;
  const double dx2 = dx.squaredNorm();
  if (dx2 > 0) {
    const double trust = dx2 / (dx2 + kTellingMove_m * kTellingMove_m);
    k += trust / dx2 * (miss * dx.transpose() + dx * miss.transpose() - dx.dot(miss) / dx2 * dx * dx.transpose());
  }
  return bounded(contact, k);
}

/// Limits the stiffness. A needle's stiffness has no coupling between along and across: only the force along it is
/// limited.
Matrix3d ContactModel::bounded(const TickContact& contact, const Matrix3d& k) const {
  if (contact.kind == Kind::kPulls) return within(k, 0, std::numeric_limits<double>::max());
  if (contact.kind == Kind::kPierces) {
    const Matrix3d along = onto(contact.along), across = Matrix3d::Identity() - along;
    const double size = contact.stiffness_n_per_m;
    return within(along * k * along + across * k * across, kSoftest * kAlongShaft * size, kStiffest * size);
  }
  Matrix3d out = within(k, 0, kStiffest * stiffnessOf(tissue_.stiffest_pa, contact));
  const Matrix3d normal = onto(directionOf(contact.reaction.force_n));
  const double least = kSoftest * stiffnessOf(tissue_.softest_pa, contact), is = (normal * out).trace();
  if (is < least) out += (least - is) * normal;
  return out;
}

void ContactModel::put(const TickContact& contact, double over_s, double now_s) {
  before_ = mixed(now_s);
  if (contact.anew) now_ = {};
  Affine next;
  next.kind = contact.kind;
  next.at_m = 0.5 * (contact.from_m + contact.to_m);
  if (contact.kind != Kind::kFree) {
    next.force_n = contact.reaction.force_n;
    next.torque_nm = contact.reaction.torque_nm;
    next.normal = directionOf(next.force_n);
    next.limit_n = contact.kind == Kind::kPulls ? kMostPull * next.force_n.norm() : contact.limit_n;
    next.along = contact.along;
    if (contact.kind == Kind::kPierces) next.ahead_n = contact.limit_n;
    next.back_n = contact.back_n;
    next.stiffness = learnt(contact, next.at_m);
    touched_m_ = next.at_m;
    touched_s_ = now_s;
  } else {
    next = leftBehind(next.at_m, now_s);
  }
  goOver(next, over_s, now_s);
}

/// Returns the model after the tip has left the surface, which stays known while the tip is near it. The force is zero
/// at the tip's position in this tick, and has the previous stiffness from the depth at which it begins. Tissue becomes
/// stiffer with depth, so the surface is no deeper than that.
ContactModel::Affine ContactModel::leftBehind(const Vector3d& at_m, double now_s) const {
  if (now_.kind != Kind::kPushes || now_s - touched_s_ > kRemembered_s) return {};
  if ((at_m - touched_m_).norm() > tissue_.tip_radius_m) return {};
  Affine out = now_;
  out.at_m = at_m;
  const double along = now_.normal.dot(now_.stiffness * now_.normal);
  out.stiffness = along * now_.normal * now_.normal.transpose();
  const double pushed = now_.normal.dot(now_.force_n - out.stiffness * (at_m - now_.at_m));
  out.force_n = std::min(pushed, 0.0) * now_.normal;
  out.torque_nm.setZero();
  return out;
}

void ContactModel::clear(double over_s, double now_s) {
  before_ = mixed(now_s);
  goOver(Affine{}, over_s, now_s);
}

/// Starts the blend from before_.
void ContactModel::goOver(const Affine& next, double over_s, double now_s) {
  now_ = next;
  since_s_ = now_s;
  over_s_ = over_s;
}

/// Returns the progress of the blend from before_ to now_, 0..1.
double ContactModel::goneOver(double now_s) const {
  return over_s_ > 0 ? std::clamp((now_s - since_s_) / over_s_, 0.0, 1.0) : 1;
}

/// Returns the blended model: a blend of two affine forces is affine.
ContactModel::Affine ContactModel::mixed(double now_s) const {
  const double w = goneOver(now_s);
  if (w == 1) return now_;
  Affine out;
  out.kind = now_.kind == Kind::kFree ? before_.kind : now_.kind;
  out.at_m = now_.at_m;
  const Vector3d force_before = before_.force_n - before_.stiffness * (now_.at_m - before_.at_m);
  out.force_n = (1 - w) * force_before + w * now_.force_n;
  out.torque_nm = (1 - w) * before_.torque_nm + w * now_.torque_nm;
  out.stiffness = (1 - w) * before_.stiffness + w * now_.stiffness;
  out.normal = directionOf((1 - w) * before_.normal + w * now_.normal);
  out.along = directionOf((1 - w) * before_.along + w * now_.along);
  out.ahead_n = (1 - w) * before_.ahead_n + w * now_.ahead_n;
  out.back_n = (1 - w) * before_.back_n + w * now_.back_n;
  const bool both = std::isfinite(before_.limit_n) && std::isfinite(now_.limit_n);
  out.limit_n = both                       ? (1 - w) * before_.limit_n + w * now_.limit_n
                : now_.kind == Kind::kFree ? before_.limit_n
                                           : now_.limit_n;
  return out;
}

/// Returns the force. Models of one kind are blended before limits apply, such as the surface of a probe; models of
/// different kinds are each limited first.
ContactModel::Force ContactModel::at(const Vector3d& tip_m, double now_s) const {
  if (before_.kind == now_.kind || before_.kind == Kind::kFree || now_.kind == Kind::kFree)
    return answer(mixed(now_s), tip_m);
  const double w = goneOver(now_s);
  const Force before = answer(before_, tip_m), now = answer(now_, tip_m);
  return {(1 - w) * before.force_n + w * now.force_n, (1 - w) * before.torque_nm + w * now.torque_nm,
          (1 - w) * before.stiffness_n_per_m + w * now.stiffness_n_per_m};
}

ContactModel::Force ContactModel::answer(const Affine& model, const Vector3d& tip_m) {
  Force out;
  if (model.kind == Kind::kFree) return out;
  out.force_n = model.force_n - model.stiffness * (tip_m - model.at_m);
  out.torque_nm = model.torque_nm;
  out.stiffness_n_per_m = model.stiffness;
  if (model.kind == Kind::kHolds) return out;
  if (model.kind == Kind::kPierces) {
    const double along_n = out.force_n.dot(model.along);
    out.force_n += (std::clamp(along_n, -model.ahead_n, model.back_n) - along_n) * model.along;
    return out;
  }
  const double pushed = model.normal.dot(out.force_n);
  if (!(pushed > 0)) return {};
  // The force across is due to the surface's slope, not a pull: it is no larger than the push.
  const Vector3d across = out.force_n - pushed * model.normal;
  const double size = across.norm();
  if (size > pushed) out.force_n = pushed * (model.normal + across / size);
  const double all = out.force_n.norm();
  if (all > model.limit_n) out.force_n *= model.limit_n / all;
  const double push_at_tick = model.normal.dot(model.force_n);
  if (push_at_tick > 0) out.torque_nm *= std::min(pushed / push_at_tick, 1.0);
  return out;
}

}  // namespace viscera
