// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/suture/needle.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "math/archive.h"
#include "solver/processes/suture/chain/chain.h"

namespace viscera {

namespace {

constexpr double kPunctureArea_m2 = 5e-6;  // puncture force over E
constexpr double kCuttingShare = 1.0 / 3;  // of the puncture force
constexpr double kFrictionDepth_m = 1e-4;  // friction per length of shaft over E
constexpr double kAroundShaft = 20;        // stiffness of the tissue around the shaft, over E and the spacing of nodes
constexpr double kCrossingsApart_m = 1.5e-3;
constexpr double kPassedApart_m = 2.2e-3;  // distance of the points that the suture gets
constexpr double kSkinApart_m = 1.2e-3;    // and distance of surface points from those inside
constexpr int kNeedleSweeps = 4;
constexpr uint32_t kChecksApart = 16;      // substeps after which a tip outside searches for tissue again
constexpr double kChecksApart_m = 1e-4;    // or displacement of the tip: the search is slow
constexpr double kTipOff_m = 2e-4;         // a tip retracted that far from the surface has left it
constexpr double kOffTip_m = 5e-4;         // tissue that far ahead of the tip has left the needle
constexpr double kLipsApart_m = 3e-4;      // points farther from the tip than this are across a wound
constexpr double kAtLimit = 0.9999;        // share of a force limit that counts as reached
constexpr double kSidelong = 0.5;          // of the puncture force, as an excess across over along: the tip slides off
constexpr double kFastestLed_m_per_s = 3;  // if moved faster, as after a roll-back, it lags behind its stylus
constexpr double kAirDrag_per_s = 4;

constexpr double kNoPosition = std::numeric_limits<double>::infinity();

std::vector<double> youngsOf(const Body& body) {
  const std::vector<std::string>& names = body.lattice.part_names;
  std::vector<double> out(1 + names.size(), body.material.young_modulus_pa);
  for (const PartConfig& part : body.parts) {
    const auto name = std::find(names.begin(), names.end(), part.part);
    if (name != names.end()) out[static_cast<size_t>(name - names.begin()) + 1] = part.young_modulus_pa;
  }
  return out;
}

Quaterniond turned(const Vector3d& by_rad) {
  const double angle = by_rad.norm();
  return angle > 0 ? Quaterniond(Eigen::AngleAxisd(angle, by_rad / angle)) : Quaterniond::Identity();
}

}  // namespace

Needle::Needle(const NeedleConfig& config, const Model& model, const Vector3d& tail_m)
    : config_(config),
      shape_(config),
      model_(model),
      start_(shape_.withTailAt(tail_m, rotationFromDegrees(config.rotation_deg))) {
  for (const Body& body : model.bodies) {
    young_pa_.push_back(youngsOf(body));
    Eigen::AlignedBox3d box;
    for (const uint32_t slot : body.lattice.active_slots) box.extend(restPosition(body, slot));
    const Vector3d more = Vector3d::Constant(0.5 * box.diagonal().norm());
    around_.extend(Eigen::AlignedBox3d(box.min() - more, box.max() + more));
  }
  reset();
}

void Needle::reset() {
  tip_ = {};
  crossings_.clear();
  last_passed_m_.setConstant(kNoPosition);
  velocity_.setZero();
  turning_.setZero();
  from_ = end_ = start_;
  led_ = false;
  dt_s_ = 0;
  force_n_.setZero();
  torque_nm_.setZero();
  work_j_ = tip_n_ = farthest_m_ = 0;
  hold_ = {};
}

/// Finds the held points again. Where there is no tissue any more, the needle releases them.
void Needle::embedAgain(const TissuePoints& tissue) {
  const auto gone = [&](TissuePoint& point) {
    const auto again = tissue.embed(point.body, point.rest_m);
    if (again) point = *again;
    return !again;
  };
  crossings_.erase(
      std::remove_if(crossings_.begin(), crossings_.end(), [&](Crossing& crossing) { return gone(crossing.point); }),
      crossings_.end());
  if (tip_.state < kTouches) return;
  if (gone(tip_.point))
    tip_.state = kBlocked;
  else
    standAt(TissuePoint(tip_.point));
}

void Needle::persist(Archive& archive) {
  archive.value(tip_);
  archive.list(crossings_);
  archive.value(last_passed_m_);
  archive.value(velocity_);
  archive.value(turning_);
  archive.value(end_);
  archive.value(led_);
}

NeedleLaw Needle::lawAt(const TissuePoint& point) const {
  const Body& body = model_.bodies[point.body];
  const auto heaviest = std::max_element(point.weights.begin(), point.weights.begin() + point.count);
  const uint32_t slot = point.slots[static_cast<size_t>(heaviest - point.weights.begin())];
  const uint32_t own = slot - model_.slotOffset(point.body);
  const size_t label = own < body.lattice.labels.size() ? body.lattice.labels[own] : 0;
  const std::vector<double>& youngs = young_pa_[point.body];
  const double young_pa = youngs[std::min(label, youngs.size() - 1)];
  NeedleLaw out;
  out.puncture_n = config_.puncture_n > 0 ? config_.puncture_n : kPunctureArea_m2 * young_pa;
  out.cutting_n = config_.cutting_n > 0 ? config_.cutting_n : kCuttingShare * out.puncture_n;
  out.friction_n_per_m = config_.friction_n_per_m > 0 ? config_.friction_n_per_m : kFrictionDepth_m * young_pa;
  out.stiffness_n_per_m = kAroundShaft * young_pa * body.lattice.spacing_m;
  return out;
}

void Needle::lead(const Pose& to, double dt_s) {
  from_ = end_;
  dt_s_ = dt_s;
  led_ = true;
  const double turn = from_.orientation.angularDistance(to.orientation);
  const double offset_m = (to.position_m - from_.position_m).norm() + 2 * turn * shape_.radius_m();
  const double most_m = kFastestLed_m_per_s * dt_s;
  end_ = offset_m > most_m ? interpolate(from_, to, most_m / offset_m) : to;
}

void Needle::fall(const Vector3d& gravity_m_per_s2, double dt_s) {
  from_ = end_;
  dt_s_ = dt_s;
  if (led_) {  // the force that the stylus carried would throw it
    tip_.impulse_ns.setZero();
    for (Crossing& crossing : crossings_) crossing.impulse_ns.setZero();
  }
  led_ = false;
  velocity_ = (velocity_ + dt_s * gravity_m_per_s2) / (1 + dt_s * kAirDrag_per_s);
  turning_ /= 1 + dt_s * kAirDrag_per_s;
  move();
}

/// Moves the needle by its velocities.
void Needle::move() {
  const Vector3d middle_m = from_ * shape_.middle() + dt_s_ * velocity_;
  end_.orientation = (turned(dt_s_ * turning_) * from_.orientation).normalized();
  end_.position_m = middle_m - end_.orientation * shape_.middle();
}

void Needle::keepOut(const layout::ObstacleMotion* obstacles, uint32_t count) {
  end_ = keptOut(shape_, from_, end_, obstacles, count);
  velocity_ = (end_ * shape_.middle() - from_ * shape_.middle()) / dt_s_;
  const Eigen::AngleAxisd turn(end_.orientation * from_.orientation.conjugate());
  turning_ = std::remainder(turn.angle(), 2 * EIGEN_PI) / dt_s_ * turn.axis();
}

Vector3d Needle::velocityAt(const Vector3d& position_m) const {
  return velocity_ + turning_.cross(position_m - end_ * shape_.middle());
}

/// Returns an upper bound on the mobility in any direction.
double Needle::mobilityAt(const Vector3d& position_m) const {
  if (led_) return 0;
  return 1 / shape_.mass_kg() + (position_m - end_ * shape_.middle()).squaredNorm() / shape_.inertia_kg_m2();
}

void Needle::push(const Vector3d& position_m, const Vector3d& impulse_ns) {
  if (led_) return;
  velocity_ += impulse_ns / shape_.mass_kg();
  turning_ += (position_m - end_ * shape_.middle()).cross(impulse_ns) / shape_.inertia_kg_m2();
  move();
}

Vector3d Needle::tailAt_m(double share) const {
  const Vector3d own = shape_.at(shape_.length_m());
  return share * (end_ * own) + (1 - share) * (from_ * own);
}

double Needle::tailMass_kg() const {
  return led_ ? kRigidMass_kg : 1 / mobilityAt(tail_m());
}

void Needle::pull(const Vector3d& impulse_ns) {
  push(tail_m(), impulse_ns);
}

void Needle::act(TissuePort& target, TissuePoints& tissue, std::vector<NeedlePassed>& passed) {
  touch(target, tissue);
  force_n_.setZero();
  torque_nm_.setZero();
  work_j_ = tip_n_ = farthest_m_ = 0;
  hold_ = {};
  if (tip_.state < kTouches && crossings_.empty()) return;
  read(target, tissue);
  sweep(tissue);
  sum(tissue);
  settle(target, tissue);
  sortOut(tissue, passed);
  tissue.write(target, layout::kMaxStyluses, dt_s_);
}

/// Starts a contact with tissue. A free needle does not start to pierce.
void Needle::touch(TissuePort& target, const TissuePoints& tissue) {
  if (tip_.state > kBlocked || (tip_.state == kClear && !led_)) return;
  const Vector3d at = end_ * shape_.at(0);
  if (++tip_.looked_ago < kChecksApart && (at - tip_.looked_m).norm() < kChecksApart_m) return;
  tip_.looked_ago = 0;
  tip_.looked_m = at;
  const std::optional<TissuePoint> point = around_.contains(at) ? tissue.find(target, at) : std::nullopt;
  if (!point) tip_.state = kClear;
  if (!point || tip_.state == kBlocked) return;
  tip_ = {};
  tip_.state = kTouches;
  standAt(*point);
}

void Needle::standAt(const TissuePoint& point) {
  tip_.point = point;
  tip_.law = lawAt(point);
}

void Needle::read(TissuePort& target, TissuePoints& tissue) const {
  std::vector<const TissuePoint*> points;
  for (const Crossing& crossing : crossings_) points.push_back(&crossing.point);
  if (tip_.state >= kTouches) points.push_back(&tip_.point);
  tissue.read(target, points);
}

/// Sweeps over all points: each applies its impulse of the last substep, then the correction.
void Needle::sweep(TissuePoints& tissue) {
  const auto again = [&](const TissuePoint& point, const Vector3d& impulse_ns) {
    tissue.give(point, impulse_ns, dt_s_);
    push(tissue.position_m(point), -impulse_ns);
  };
  for (const Crossing& crossing : crossings_) again(crossing.point, crossing.impulse_ns);
  if (tip_.state >= kTouches) again(tip_.point, tip_.impulse_ns);
  for (int i = 0; i < kNeedleSweeps; ++i) {
    for (Crossing& crossing : crossings_) {
      const Vector3d own = end_.inverse() * tissue.position_m(crossing.point);
      const double behind_m = std::clamp(shape_.nearest_m(own), 0.0, shape_.length_m());
      const double limit_n = crossing.law.friction_n_per_m * crossing.length_m;
      solve(tissue, {&crossing.point, &crossing.impulse_ns, end_ * shape_.at(behind_m),
                     end_.orientation * shape_.forward(behind_m), -limit_n, limit_n,
                     1 / (crossing.law.stiffness_n_per_m * dt_s_ * dt_s_), false});
    }
    if (tip_.state >= kTouches) solveTip(tissue);
  }
}

void Needle::solveTip(TissuePoints& tissue) {
  const bool inside = tip_.state == kInside;
  solve(tissue, {&tip_.point, &tip_.impulse_ns, end_ * shape_.at(0), end_.orientation * shape_.forward(0), 0,
                 inside ? tip_.law.cutting_n : tip_.law.puncture_n,
                 inside ? 1 / (tip_.law.stiffness_n_per_m * dt_s_ * dt_s_) : 0, !inside});
}

void Needle::solve(TissuePoints& tissue, const Row& row) {
  const double mobility = tissue.mobility(*row.point, *row.point);
  if (!(mobility > 0)) return;
  const double both = mobility + mobilityAt(row.at_m), soft = row.softness_per_kg;
  const Vector3d gap = (row.at_m - tissue.position_m(*row.point)) / dt_s_;
  const Vector3d rate = velocityAt(row.at_m) - tissue.velocity_m_per_s(*row.point);
  const Vector3d before = *row.impulse_ns;
  const double before_along = before.dot(row.along);
  const Vector3d before_across = before - before_along * row.along;
  const double asked = (row.holds ? gap : rate).dot(row.along) / both;
  const double along = std::clamp(before_along + asked, row.low_n * dt_s_, row.high_n * dt_s_);
  const Vector3d across = gap - gap.dot(row.along) * row.along;
  *row.impulse_ns = before_across + (across - soft * before_across) / (both + soft) + along * row.along;
  const Vector3d more = *row.impulse_ns - before;
  tissue.give(*row.point, more, dt_s_);
  push(row.at_m, -more);
}

void Needle::sum(const TissuePoints& tissue) {
  const auto add = [&](const TissuePoint& point, const Vector3d& impulse_ns) {
    force_n_ += impulse_ns / dt_s_;
    work_j_ += impulse_ns.dot(tissue.velocity_m_per_s(point));
    torque_nm_ += tissue.position_m(point).cross(impulse_ns) / dt_s_;
  };
  for (const Crossing& crossing : crossings_) {
    add(crossing.point, crossing.impulse_ns);
    const Vector3d position = tissue.position_m(crossing.point);
    const double behind_m = std::clamp(shape_.nearest_m(end_.inverse() * position), 0.0, shape_.length_m());
    farthest_m_ = std::max(farthest_m_, (position - end_ * shape_.at(behind_m)).norm());
    addToHold(crossing.point, crossing.law, crossing.length_m, behind_m);
    const double limit_n = crossing.law.friction_n_per_m * crossing.length_m;
    const double is_n = crossing.impulse_ns.dot(end_.orientation * shape_.forward(behind_m)) / dt_s_;
    hold_.ahead_n += limit_n - is_n;
    hold_.back_n += limit_n + is_n;
  }
  if (tip_.state >= kTouches) {
    add(tip_.point, tip_.impulse_ns);
    tip_n_ = tip_.impulse_ns.dot(end_.orientation * shape_.forward(0)) / dt_s_;
    addToHold(tip_.point, tip_.law, tissue.spacing_m(tip_.point.body), 0);
    hold_.ahead_n += (tip_.state == kInside ? tip_.law.cutting_n : tip_.law.puncture_n) - tip_n_;
    hold_.back_n += tip_n_;
  }
  hold_.along.normalize();
}

/// Adds a point to the hold. The stiffness of tissue around a length of shaft is E times the length; ahead of a tip it
/// is that of a cell, E times its size.
void Needle::addToHold(const TissuePoint& point, const NeedleLaw& law, double length_m, double behind_m) {
  const double cell_m = model_.bodies[point.body].lattice.spacing_m;
  hold_.stiffness_n_per_m += law.stiffness_n_per_m / kAroundShaft * length_m / cell_m;
  hold_.along += length_m * (end_.orientation * shape_.forward(behind_m));
}

/// Updates the state of the tip.
void Needle::settle(TissuePort& target, const TissuePoints& tissue) {
  if (tip_.state < kTouches) return;
  const Vector3d along = end_.orientation * shape_.forward(0);
  const double slip_m = (end_ * shape_.at(0) - tissue.position_m(tip_.point)).dot(along);
  if (tip_.state == kInside) {
    goOn(target, tissue, slip_m);
    return;
  }
  const double most_n = tip_.law.puncture_n;
  const double across_n = (tip_.impulse_ns / dt_s_ - tip_n_ * along).norm();
  const bool enters = tip_.state == kTouches;
  if (tip_n_ >= kAtLimit * most_n && slip_m > shape_.wireRadius_m()) {
    leaveCrossing(true);
    tip_.state = enters ? kInside : kBlocked;
  } else if (tip_n_ <= 0 && slip_m < -kTipOff_m) {
    tip_.state = enters ? kBlocked : kInside;
  } else if (enters && across_n > tip_n_ + kSidelong * most_n) {
    tip_.state = kBlocked;
  }
}

/// Advances the tip's point by its slip, in the tissue at rest. If the new point is across a wound, the tip may not be
/// there yet: the point stays while the tip is outside tissue.
void Needle::goOn(TissuePort& target, const TissuePoints& tissue, double slip_m) {
  const Vector3d tip_m = end_ * shape_.at(0), along = end_.orientation * shape_.forward(0);
  Vector3d step = tissue.toRest(tip_.point, slip_m * along);
  if (step.norm() > 0.5 * kCrossingsApart_m) step *= 0.5 * kCrossingsApart_m / step.norm();
  if (step.isZero(0)) return;
  const Vector3d rest = tip_.point.rest_m;
  double share = 1;
  std::optional<TissuePoint> next = tissue.embed(tip_.point.body, rest + step);
  const bool out = !next;
  for (int i = 0; i < 6 && out; ++i) {
    const double more = share - std::ldexp(1.0, -i - 1);
    const auto nearer = tissue.embed(tip_.point.body, rest + more * step);
    if (nearer)
      next = nearer;
    else
      share = more;
  }
  if (next && std::copysign(1, slip_m) * (tissue.positionIn(target, *next) - tip_m).dot(along) > kLipsApart_m) {
    next = tissue.find(target, tip_m);
    if (!next) return;
  }
  if (next) standAt(*next);
  const Vector3d gone = tip_.point.rest_m - rest;
  tip_.path_m += std::copysign(gone.norm(), slip_m * gone.dot(step));
  if (out) tip_.state = slip_m > 0 ? kLeaves : kBlocked;
  if (tip_.path_m >= kCrossingsApart_m + (crossings_.empty() ? -kNoPosition : crossings_.back().path_m))
    leaveCrossing(false);
}

void Needle::leaveCrossing(bool skin) {
  Crossing crossing;
  crossing.point = tip_.point;
  crossing.law = tip_.law;
  crossing.path_m = tip_.path_m;
  crossing.length_m = tip_.state == kTouches || crossings_.empty() ? 0 : tip_.path_m - crossings_.back().path_m;
  crossing.skin = skin;
  crossing.enters = tip_.state == kTouches;
  crossings_.push_back(crossing);
}

/// Removes points that are no longer on the shaft: the tip was retracted past them, or the tail has passed them.
void Needle::sortOut(const TissuePoints& tissue, std::vector<NeedlePassed>& passed) {
  const auto gone = [&](const Crossing& crossing) {
    const double behind_m = shape_.nearest_m(end_.inverse() * tissue.position_m(crossing.point));
    const double beyond_m = behind_m - shape_.length_m();
    if (behind_m < -kOffTip_m) return true;
    if (beyond_m <= 0) return false;
    const double least_m = crossing.skin ? kSkinApart_m : kPassedApart_m;
    if ((crossing.point.rest_m - last_passed_m_).norm() < least_m) return true;
    last_passed_m_ = crossing.point.rest_m;
    passed.push_back({crossing.point, beyond_m, crossing.enters != 0});
    return true;
  };
  crossings_.erase(std::remove_if(crossings_.begin(), crossings_.end(), gone), crossings_.end());
}

}  // namespace viscera
