// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/suture/needles.h"

#include <algorithm>

#include "math/archive.h"
#include "model/scene/tool_kinds.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

namespace {

/// Returns the distance of a position from an arc.
double distanceTo_m(const Needle& needle, const Vector3d& position_m) {
  const NeedleShape& shape = needle.shape();
  const double behind_m = shape.nearest_m(needle.pose().inverse() * position_m);
  return (needle.pose() * shape.at(std::clamp(behind_m, 0.0, shape.length_m())) - position_m).norm();
}

/// Adds a hold to the mean of the tick. @param share  of the tick
void add(const NeedleHold& hold, double share, NeedleHold& tick) {
  const NeedleHold before = tick;
  tick = hold;
  tick.ahead_n = before.ahead_n + share * hold.ahead_n;
  tick.back_n = before.back_n + share * hold.back_n;
}

}  // namespace

Needles::Needles(const Scene& scene, const Model& model)
    : styluses_(scene.styluses),
      sutures_(scene.sutures),
      model_(model),
      gravity_(scene.environment.gravity_m_per_s2),
      tick_s_(1 / scene.solver.tick_hz) {
  for (uint32_t t = 0; t < scene.sutures.size(); ++t) {
    const SutureConfig& suture = scene.sutures[t];
    if (suture.needle.arc == NeedleArc::kNone) continue;
    needles_.push_back({t, Needle(suture.needle, model, suture.position_m), {}});
  }
}

const Needle* Needles::find(size_t suture) const {
  for (const OnThread& one : needles_) {
    if (one.suture == suture) return &one.needle;
  }
  return nullptr;
}

size_t Needles::holderOf(size_t suture) const {
  for (const OnThread& one : needles_) {
    if (one.suture == suture) return one.held.stylus;
  }
  return layout::kMaxStyluses;
}

void Needles::beginTick(const ToolMotions& motions) {
  motions_ = motions;
  pulls_ = {};
  work_j_ = 0;
  for (uint32_t s = 0; s < styluses_.size(); ++s) {
    const bool takes = motions[s].present && motions[s].mode == ToolMode::kNeedle;
    for (OnThread& one : needles_) {
      if (one.held.stylus == s && !takes) one.held = {};
    }
    if (takes && !takes_[s]) take(s, motions[s].from);
    takes_[s] = takes;
  }
  for (const OnThread& one : needles_) {
    if (one.held.stylus < pulls_.size() && one.needle.isInTissue()) pulls_[one.held.stylus].nodes = 1;
  }
}

void Needles::take(uint32_t stylus, const Pose& tip) {
  double nearest_m = kindOf(ToolMode::kNeedle).reach_m(styluses_[stylus]);
  OnThread* taken = nullptr;
  for (OnThread& one : needles_) {
    const double distance_m = distanceTo_m(one.needle, tip.position_m);
    if (distance_m > nearest_m) continue;
    nearest_m = distance_m;
    taken = &one;
  }
  if (taken) taken->held = {stylus, tip.inverse() * taken->needle.pose()};
}

void Needles::act(TissuePort& target, TissuePoints& tissue, double at, double dt_s,
                  const layout::ObstacleMotion* obstacles, uint32_t count, const Passes& passes) {
  for (OnThread& one : needles_) {
    const uint32_t stylus = one.held.stylus;
    const bool led = stylus < layout::kMaxStyluses;
    if (led)
      one.needle.lead(interpolate(motions_[stylus].from, motions_[stylus].to, at) * one.held.in_grip, dt_s);
    else
      one.needle.fall(gravity_, dt_s);
    one.needle.keepOut(obstacles, count);
    passed_.clear();
    one.needle.act(target, tissue, passed_);
    for (const NeedlePassed& passed : passed_)
      passes(one.suture, passed, trackLawOf(sutures_[one.suture], model_.bodies[passed.point.body]));
    work_j_ += one.needle.work_j();
    if (!led) continue;
    const Vector3d& tip = motions_[stylus].to.position_m;
    add(one.needle.hold(), dt_s / tick_s_, pulls_[stylus].needle);
    pulls_[stylus].impulse_ns += dt_s * one.needle.force_n();
    pulls_[stylus].moment_nms += dt_s * (one.needle.torque_nm() - tip.cross(one.needle.force_n()));
  }
}

void Needles::lay(uint32_t suture, double share, ChainHold& hold) const {
  const Needle& needle = *find(suture);
  hold.to_m = needle.tailAt_m(share);
  hold.mass_kg = hold.stiffness_kg = needle.tailMass_kg();
}

void Needles::takeOver(uint32_t suture, const ChainHold& hold) {
  for (OnThread& one : needles_) {
    if (one.suture != suture) continue;
    one.needle.pull(hold.impulse_ns);
    if (one.held.stylus >= layout::kMaxStyluses) continue;
    StylusPull& pull = pulls_[one.held.stylus];
    pull.impulse_ns -= hold.impulse_ns;
    pull.moment_nms -= (hold.to_m - motions_[one.held.stylus].to.position_m).cross(hold.impulse_ns);
  }
}

void Needles::reset() {
  for (OnThread& one : needles_) {
    one.needle.reset();
    one.held = {};
  }
  takes_ = {};
}

void Needles::embedAgain(const TissuePoints& tissue) {
  for (OnThread& one : needles_) one.needle.embedAgain(tissue);
}

void Needles::persist(Archive& archive) {
  for (OnThread& one : needles_) one.needle.persist(archive);
}

void Needles::persistTools(Archive& archive) {
  for (OnThread& one : needles_) archive.value(one.held);
  archive.value(takes_);
}

void Needles::addTo(StateHash& hash) const {
  for (const OnThread& one : needles_) {
    const Pose& pose = one.needle.pose();
    for (const double part : pose.position_m) hash.add(static_cast<float>(part));
    for (const double part : pose.orientation.coeffs()) hash.add(static_cast<float>(part));
  }
}

}  // namespace viscera
