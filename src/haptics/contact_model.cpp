// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/haptics/contact_model.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>

namespace viscera {
namespace {

using Kind = TickContact::Kind;

/// A tip that moved less than this from one tick to the next says little: noise of the device and sway of the tissue
/// are of this size [m].
constexpr double kTellingMove_m = 5e-5;
/// A force below this has no direction that can be trusted [N].
constexpr double kLeastForce_n = 1e-9;
/// For so long a surface that was left is where it was [s].
constexpr double kRemembered_s = 0.3;
/// What is learnt stays within these shares of what the tissue's constants say: a thin layer on bone is stiffer than a
/// half space, a flap is softer.
constexpr double kSoftest = 0.3, kStiffest = 6;
/// Of a blade's limit: a force above that says nothing of a stiffness, as the edge goes on.
constexpr double kYields = 0.9;

Vector3d directionOf(const Vector3d& v) {
  const double length = v.norm();
  return length > kLeastForce_n ? Vector3d(v / length) : Vector3d(Vector3d::Zero());
}

/// The nearest symmetric matrix with eigenvalues within limits.
Matrix3d within(const Matrix3d& k, double least, double most) {
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(0.5 * (k + k.transpose()));
  const Vector3d values = solver.eigenvalues().cwiseMax(least).cwiseMin(most);
  return solver.eigenvectors() * values.asDiagonal() * solver.eigenvectors().transpose();
}

}  // namespace

/// Along the normal [N/m]. Hertz: F = 4/3 E* sqrt(r) d^1.5, so dF/dd = 2 E* sqrt(r d), E* = E / (1 - nu^2). A sphere
/// that tissue holds: 24 pi mu (1 - nu) r / (5 - 6 nu) in an infinite solid, half of it at a surface.
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

/// What the last two ticks say, beside what was known. Powell's symmetric update: of all symmetric K with K dx = -dF
/// the nearest to the one before.
Matrix3d ContactModel::learnt(const TickContact& contact, const Vector3d& at_m) const {
  const double first = stiffnessOf(tissue_.stiffest_pa, contact);
  const Vector3d normal = directionOf(contact.reaction.force_n);
  if (contact.kind != now_.kind) {
    if (contact.kind == Kind::kHolds) return first * Matrix3d::Identity();
    return first * normal * normal.transpose();
  }
  if (contact.reaction.force_n.norm() > kYields * contact.limit_n) return now_.stiffness;
  const Vector3d dx = at_m - now_.at_m, miss = now_.force_n - contact.reaction.force_n - now_.stiffness * dx;
  const double dx2 = dx.squaredNorm();
  Matrix3d k = now_.stiffness;
  if (dx2 > 0) {
    const double trust = dx2 / (dx2 + kTellingMove_m * kTellingMove_m);
    k += trust / dx2 * (miss * dx.transpose() + dx * miss.transpose() - dx.dot(miss) / dx2 * dx * dx.transpose());
  }
  k = within(k, 0, kStiffest * first);
  const double along = normal.dot(k * normal);
  const double least = kSoftest * stiffnessOf(tissue_.softest_pa, contact);
  if (along < least) k += (least - along) * normal * normal.transpose();
  return k;
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
    next.limit_n = contact.limit_n;
    next.stiffness = learnt(contact, next.at_m);
    touched_m_ = next.at_m;
    touched_s_ = now_s;
  } else {
    next = leftBehind(next.at_m, now_s);
  }
  goOver(next, over_s, now_s);
}

/// The tip has left the surface, which stays known while the tip is near it: no force where the tip was in this tick,
/// and from where the force would begin the same stiffness as before. Tissue is stiffer the deeper a tip is, so its
/// surface lies no deeper than that.
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

void ContactModel::forget(double over_s, double now_s) {
  before_ = mixed(now_s);
  goOver(Affine{}, over_s, now_s);
}

/// From before_.
void ContactModel::goOver(const Affine& next, double over_s, double now_s) {
  now_ = next;
  since_s_ = now_s;
  over_s_ = over_s;
}

/// A mixture of two affine forces is one.
ContactModel::Affine ContactModel::mixed(double now_s) const {
  const double w = over_s_ > 0 ? std::clamp((now_s - since_s_) / over_s_, 0.0, 1.0) : 1;
  if (w == 1) return now_;
  Affine out;
  out.kind = now_.kind == Kind::kFree ? before_.kind : now_.kind;
  out.at_m = now_.at_m;
  const Vector3d force_before = before_.force_n - before_.stiffness * (now_.at_m - before_.at_m);
  out.force_n = (1 - w) * force_before + w * now_.force_n;
  out.torque_nm = (1 - w) * before_.torque_nm + w * now_.torque_nm;
  out.stiffness = (1 - w) * before_.stiffness + w * now_.stiffness;
  out.normal = directionOf((1 - w) * before_.normal + w * now_.normal);
  const bool both = std::isfinite(before_.limit_n) && std::isfinite(now_.limit_n);
  out.limit_n = both                       ? (1 - w) * before_.limit_n + w * now_.limit_n
                : now_.kind == Kind::kFree ? before_.limit_n
                                           : now_.limit_n;
  return out;
}

ContactModel::Force ContactModel::at(const Vector3d& tip_m, double now_s) const {
  const Affine model = mixed(now_s);
  Force out;
  if (model.kind == Kind::kFree) return out;
  out.force_n = model.force_n - model.stiffness * (tip_m - model.at_m);
  out.torque_nm = model.torque_nm;
  out.stiffness_n_per_m = model.stiffness;
  if (model.kind == Kind::kHolds) return out;
  const double pushed = model.normal.dot(out.force_n);
  if (!(pushed > 0)) return {};
  // What acts across is the surface's slope, not a pull: no larger than the push.
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
