// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/blade/blade_point.h"

#include <algorithm>
#include <limits>

#include "math/archive.h"
#include "math/vec4.h"
#include "solver/processes/blade/blade_edge.h"

namespace viscera {

namespace {

constexpr double kPointStale = 0.05;    // of the spacing: a front that far from its kernel's centre gets a new one
constexpr double kPointClosed = 0.2;    // share of a gap that is closed per substep
constexpr double kMostPointStep = 0.5;  // of the spacing: largest step of the front in a substep
constexpr double kPart = 0.02;          // of the spacing: step of the path through thin layers
constexpr double kPointLeft = 2;        // of the spacing: a front that far ahead of the point becomes free
constexpr double kPointAhead = 0.9;     // of the spacing: distance ahead at which whole tissue is searched for

}  // namespace

BladePoint::BladePoint(RestTissue& tissue, double width_m)
    : tissue_(tissue),
      width_m_(width_m),
      kernel_m_(tissue.toughness().pointKernel_m(width_m)),
      h_(tissue.toughness().spacing_m()) {}

double BladePoint::act(TissuePort& target, uint32_t stylus, const layout::ToolMotion& blade, double dt_s) {
  const Vector3d from = xyz(blade.blade_from), to = xyz(blade.blade_to);
  const Vector3d into = (to - xyz(blade.to)).normalized(), edge_velocity = (to - from) / dt_s;
  if (!tip_.is_there) {
    tip_ = {};
    tip_.at = tip_.edge = from;
    tip_.is_there = 1;
    tip_.centre.setConstant(std::numeric_limits<double>::infinity());
  }
  renewKernel(target);
  Vector3d u_m, v;
  kernel_.means(near_, u_m, v);
  Vector3d gap = tip_.edge - (tip_.at + u_m - dt_s * v);
  tip_.edge = to;
  const double cap_n = tip_.stuck ? fill(tip_.at) * tissue_.toughness().ofPoint_n(tip_.at, width_m_, kernel_m_) : 0;
  kernel_.spread(near_, spread_);
  const double mobility = kernel_.mobility(spread_);
  double push_n_s = 0, stored_j = 0;
  bool slips = tip_.stuck != 0;
  done_.limit_n = cap_n;
  if (cap_n > 0 && mobility > 0) {
    const double asked = (edge_velocity + kPointClosed / dt_s * gap - v).dot(into) / mobility;
    push_n_s = std::clamp(asked, 0.0, cap_n * dt_s);
    slips = asked > cap_n * dt_s;
  }
  if (push_n_s > 0) {
    for (std::vector<float>& momenta : momenta_) momenta.assign(near_.share.size(), 0);
    kernel_.give((push_n_s * into).cast<float>(), momenta_);
    near_.toVelocities(momenta_);
    target.pushRuns(stylus, static_cast<float>(dt_s), near_.runs, momenta_);
    v += push_n_s * mobility * into;
    done_.work_j += push_n_s * into.dot(edge_velocity);
    stored_j = push_n_s * std::min(into.dot(edge_velocity), into.dot(v));
  }
  gap += dt_s * (edge_velocity - v);
  advance(gap, into, slips);
  if (!tip_.stuck && isInTissue() && edge_velocity.dot(into) > 0 &&
      !tissue_.isParted(tip_.at + kPointAhead * h_ * into))
    tip_.stuck = 1;
  return stored_j;
}

void BladePoint::renewKernel(TissuePort& target) {
  if (!((tip_.at - tip_.centre).norm() <= kPointStale * h_)) {
    tip_.centre = tip_.at;
    makeKernel();
  }
  if (!near_.runs.empty()) target.readRuns(near_.runs, near_.u, near_.v);
  if (kernel_.is_new) tip_.to_rest = kernel_.toRest(near_);
}

void BladePoint::makeKernel() {
  near_.gather(tissue_, {tip_.centre}, Vector3d::UnitX(), kernel_m_);
  kernel_.make(near_, tip_.centre, kernel_m_);
}

/// Moves the front. @param gap  from the front to the point, in the current tissue
void BladePoint::advance(const Vector3d& gap, const Vector3d& into, bool slips) {
  if (tip_.stuck && (gap.dot(into) < -kPointLeft * h_ || !isInTissue())) tip_.stuck = 0;
  const Vector3d offset = tip_.stuck ? Vector3d(gap.dot(into) * into) : gap;
  if (tip_.stuck && (!slips || gap.dot(into) <= 0)) return;
  Vector3d step = isInTissue() ? Vector3d(tip_.to_rest * offset) : offset;
  if (isInTissue() && step.norm() > kMostPointStep * h_) step *= kMostPointStep * h_ / step.norm();
  const Vector3d before = tip_.at;
  tip_.at += step;
  if (!tip_.stuck) return;
  tissue_.part(before, tip_.at, tip_.at, before);
  const int parts = 1 + static_cast<int>(step.norm() / (kPart * h_));
  for (int i = 0; i < parts; ++i) {
    const Vector3d at = before + (i + 0.5) / parts * step;
    const double offset_m = fill(at) * step.norm() / parts;
    done_.area_m2 += offset_m * width_m_;
    done_.parting_j += offset_m * tissue_.toughness().ofPoint_n(at, width_m_, kernel_m_);
  }
}

/// Returns 1 inside the surface, which a point crosses at once; of a sheet the share of its thickness.
double BladePoint::fill(const Vector3d& at_m) const {
  const double share = tissue_.fill(at_m);
  return tissue_.isSheet() ? share : share >= 0.5;
}

void BladePoint::leave() {
  tip_.is_there = 0;
  done_.limit_n = 0;
}

void BladePoint::reset() {
  tip_ = {};
  done_ = {};
}

/// Saves or restores. The kernel is derived from the front.
void BladePoint::persist(Archive& archive) {
  archive.value(tip_);
  archive.value(done_);
  if (!archive.reads()) return;
  makeKernel();
  kernel_.is_new = false;
}

}  // namespace viscera
