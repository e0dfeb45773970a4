// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/suture/suture_grips.h"

#include <Eigen/Geometry>

#include "math/archive.h"

namespace viscera {

void SutureGrips::beginTick(const ToolMotions& motions, const std::vector<const Chain*>& sutures) {
  motions_ = motions;
  pulls_ = {};
  for (size_t s = 0; s < styluses_.size(); ++s) {
    const StylusMotion& motion = motions[s];
    Grip& grip = grips_[s];
    const bool grabs = motion.present && motion.mode == ToolMode::kGrab;
    if (!grabs || motion.hold_begins) grip.holds = false;
    if (grabs && motion.hold_begins) takeHold(grip, motion.from, styluses_[s].grab.radius_m, sutures);
    if (grip.holds) pulls_[s].nodes = 2;
  }
}

void SutureGrips::takeHold(Grip& grip, const Pose& tip, double reach_m, const std::vector<const Chain*>& sutures) {
  double nearest_m = reach_m;
  for (uint32_t t = 0; t < sutures.size(); ++t) {
    const std::vector<Vector3d>& positions = sutures[t]->positions_m();
    for (uint32_t i = 0; i + 1 < positions.size(); ++i) {
      const double distance_m = (positions[i] - tip.position_m).norm();
      if (distance_m > nearest_m) continue;
      nearest_m = distance_m;
      grip = {
          t, i, true, {tip.inverse() * positions[i], tip.inverse() * positions[i + 1]}, {kRigidMass_kg, kRigidMass_kg}};
    }
  }
}

void SutureGrips::addHolds(uint32_t suture, double at, std::vector<ChainHold>& holds) const {
  for (size_t s = 0; s < styluses_.size(); ++s) {
    const Grip& grip = grips_[s];
    if (!grip.holds || grip.suture != suture) continue;
    const Pose tip = interpolate(motions_[s].from, motions_[s].to, at);
    for (uint32_t k = 0; k < 2; ++k) {
      ChainHold hold;
      hold.node = grip.node + k;
      hold.to_m = tip * grip.positions_m[k];
      hold.most_n = styluses_[s].max_force_n / 2;
      hold.stiffness_kg = grip.stiffness_kg[k];
      holds.push_back(hold);
    }
  }
}

void SutureGrips::takeOver(uint32_t suture, const std::vector<ChainHold>& holds, size_t first) {
  for (size_t s = 0; s < styluses_.size(); ++s) {
    Grip& grip = grips_[s];
    if (!grip.holds || grip.suture != suture) continue;
    for (double& stiffness_kg : grip.stiffness_kg) {
      const ChainHold& hold = holds[first++];
      stiffness_kg = hold.stiffness_kg;
      pulls_[s].impulse_ns -= hold.impulse_ns;
      pulls_[s].moment_nms -= (hold.to_m - motions_[s].to.position_m).cross(hold.impulse_ns);
    }
  }
}

std::vector<uint32_t> SutureGrips::nodesOf(uint32_t suture) const {
  std::vector<uint32_t> out;
  for (const Grip& grip : grips_) {
    if (grip.holds && grip.suture == suture) out.push_back(grip.node);
  }
  return out;
}

void SutureGrips::parted(uint32_t suture, uint32_t node, uint32_t behind) {
  for (Grip& grip : grips_) {
    if (grip.suture != suture || grip.node < node) continue;
    grip.suture = behind;
    grip.node -= node;
  }
}

void SutureGrips::letGoMissing(const std::vector<size_t>& nodes) {
  for (Grip& grip : grips_) grip.holds &= grip.suture < nodes.size() && grip.node + 1 < nodes[grip.suture];
}

void SutureGrips::persist(Archive& archive) {
  archive.value(grips_);
}

}  // namespace viscera
