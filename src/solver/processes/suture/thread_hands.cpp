// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/suture/thread_hands.h"

#include <Eigen/Geometry>

#include "math/archive.h"

namespace viscera {

void ThreadHands::beginTick(const ToolMotions& motions, const std::vector<const Chain*>& threads) {
  motions_ = motions;
  pulls_ = {};
  for (size_t s = 0; s < styluses_.size(); ++s) {
    const StylusMotion& motion = motions[s];
    Grip& grip = grips_[s];
    const bool grabs = motion.present && motion.mode == ToolMode::kGrab;
    if (!grabs || motion.hold_begins) grip.holds = false;
    if (grabs && motion.hold_begins) takeHold(grip, motion.from, styluses_[s].grab.radius_m, threads);
    if (grip.holds) pulls_[s].nodes = 2;
  }
}

void ThreadHands::takeHold(Grip& grip, const Pose& tip, double reach_m, const std::vector<const Chain*>& threads) {
  double nearest_m = reach_m;
  for (uint32_t t = 0; t < threads.size(); ++t) {
    const std::vector<Vector3d>& places = threads[t]->places_m();
    for (uint32_t i = 0; i + 1 < places.size(); ++i) {
      const double distance_m = (places[i] - tip.position_m).norm();
      if (distance_m > nearest_m) continue;
      nearest_m = distance_m;
      grip = {t, i, true, {tip.inverse() * places[i], tip.inverse() * places[i + 1]}, {kRigidMass_kg, kRigidMass_kg}};
    }
  }
}

void ThreadHands::addHolds(uint32_t thread, double at, std::vector<ChainHold>& holds) const {
  for (size_t s = 0; s < styluses_.size(); ++s) {
    const Grip& grip = grips_[s];
    if (!grip.holds || grip.thread != thread) continue;
    const Pose tip = interpolate(motions_[s].from, motions_[s].to, at);
    for (uint32_t k = 0; k < 2; ++k) {
      ChainHold hold;
      hold.node = grip.node + k;
      hold.to_m = tip * grip.places_m[k];
      hold.most_n = styluses_[s].max_force_n / 2;
      hold.stiffness_kg = grip.stiffness_kg[k];
      holds.push_back(hold);
    }
  }
}

void ThreadHands::takeOver(uint32_t thread, const std::vector<ChainHold>& holds, size_t first) {
  for (size_t s = 0; s < styluses_.size(); ++s) {
    Grip& grip = grips_[s];
    if (!grip.holds || grip.thread != thread) continue;
    for (double& stiffness_kg : grip.stiffness_kg) {
      const ChainHold& hold = holds[first++];
      stiffness_kg = hold.stiffness_kg;
      pulls_[s].impulse_ns -= hold.impulse_ns;
      pulls_[s].moment_nms -= (hold.to_m - motions_[s].to.position_m).cross(hold.impulse_ns);
    }
  }
}

std::vector<uint32_t> ThreadHands::nodesOf(uint32_t thread) const {
  std::vector<uint32_t> out;
  for (const Grip& grip : grips_) {
    if (grip.holds && grip.thread == thread) out.push_back(grip.node);
  }
  return out;
}

void ThreadHands::parted(uint32_t thread, uint32_t node, uint32_t behind) {
  for (Grip& grip : grips_) {
    if (grip.thread != thread || grip.node < node) continue;
    grip.thread = behind;
    grip.node -= node;
  }
}

void ThreadHands::letGoMissing(const std::vector<size_t>& nodes) {
  for (Grip& grip : grips_) grip.holds &= grip.thread < nodes.size() && grip.node + 1 < nodes[grip.thread];
}

void ThreadHands::persist(Archive& archive) {
  archive.value(grips_);
}

}  // namespace viscera
