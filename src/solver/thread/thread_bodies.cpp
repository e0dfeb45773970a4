// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/thread/thread_bodies.h"

#include <algorithm>
#include <cmath>

#include "math/archive.h"
#include "viscera/layout/limits.h"
#include "viscera/math/error.h"
#include "viscera/math/state_hash.h"

namespace viscera {

namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kSubstep_s = 5e-4;

struct Preset {
  double young_modulus_pa, density_kg_per_m3, bending_share;
};

/// docs/thread.md 3.
Preset presetOf(ThreadMaterial material) {
  switch (material) {
    case ThreadMaterial::kSilk:
      return {8.7e9, 1300, 0.05};
    case ThreadMaterial::kNylon:
      return {2.5e9, 1140, 1};
    default:
      return {3.0e9, 910, 1};
  }
}

/// Middle of the class of average diameters.
double radiusOf_m(ThreadSize size) {
  constexpr double kDiameters_mm[] = {0.32, 0.225, 0.175, 0.125, 0.085};
  return 0.5e-3 * kDiameters_mm[static_cast<size_t>(size)];
}

double orElse(double value, double otherwise) {
  return value > 0 ? value : otherwise;
}

/// Goes along a path in straight steps of one length; at its end the path goes on straight.
class Walk {
 public:
  explicit Walk(const ThreadConfig& config) : path_{config.position_m}, at_(config.position_m) {
    for (const ThreadPlace& place : config.path) {
      if (place.position_m != path_.back()) path_.push_back(place.position_m);
    }
    if (path_.size() < 2)
      throw SceneError("thread '" + config.name + "': 'path' must hold a place that is not 'position_m'");
  }
  double length_m() const {
    double out = 0;
    for (size_t i = 1; i < path_.size(); ++i) out += (path_[i] - path_[i - 1]).norm();
    return out;
  }
  const Vector3d& at() const { return at_; }
  void go(double distance_m) {
    for (;; ++next_) {
      const Vector3d& from = path_[next_ - 1];
      const Vector3d way = path_[next_] - from;
      const double length2 = way.squaredNorm(), near = way.dot(at_ - from) / length2;
      const double off2 = (from + near * way - at_).squaredNorm();
      const double share = near + std::sqrt(std::max(0.0, distance_m * distance_m - off2) / length2);
      if (share > 1 && next_ + 1 < path_.size()) continue;
      at_ = from + share * way;
      return;
    }
  }

 private:
  std::vector<Vector3d> path_;  ///< without places that are twice the same
  Vector3d at_;
  size_t next_ = 1;  ///< end of the piece that it is on
};

ChainHold holdOf(uint32_t node, const Vector3d& to_m) {
  ChainHold out;
  out.node = node;
  out.to_m = to_m;
  return out;
}

}  // namespace

ChainMaterial materialOf(const ThreadConfig& config) {
  const Preset preset = presetOf(config.material);
  ChainMaterial out;
  out.radius_m = orElse(config.radius_m, radiusOf_m(config.usp));
  out.density_kg_per_m3 = orElse(config.density_kg_per_m3, preset.density_kg_per_m3);
  out.bending_nm2 = orElse(config.bending_share, preset.bending_share) *
                    orElse(config.young_modulus_pa, preset.young_modulus_pa) * kPi * std::pow(out.radius_m, 4) / 4;
  out.drag_per_s = config.drag_per_s;
  return out;
}

std::vector<Vector3d> placesOf(const ThreadConfig& config) {
  Walk walk(config);
  const double length_m = orElse(config.length_m, walk.length_m());
  const int links = static_cast<int>(std::lround(length_m / config.spacing_m));
  std::vector<Vector3d> out = {walk.at()};
  for (int i = 0; i < std::max(links, 2); ++i) {
    walk.go(config.spacing_m);
    out.push_back(walk.at());
  }
  return out;
}

ThreadBodies::ThreadBodies(const Scene& scene)
    : styluses_(scene.styluses),
      obstacles_(scene.obstacles),
      tick_s_(1 / scene.solver.tick_hz),
      substeps_(static_cast<int>(std::ceil(tick_s_ / kSubstep_s))) {
  for (const ThreadConfig& config : scene.threads) {
    Thread thread{Chain(materialOf(config), placesOf(config)), {}, 0, {}};
    const auto last = static_cast<uint32_t>(thread.chain.nodes() - 1);
    for (const uint32_t node : {0U, last}) {
      if ((node == 0 ? config.start : config.end) == ThreadEnd::kFree) continue;
      thread.around.holds.push_back(holdOf(node, thread.chain.places_m()[node]));
    }
    thread.fixed_holds = thread.around.holds.size();
    thread.around.gravity_m_per_s2 = scene.environment.gravity_m_per_s2;
    threads_.push_back(std::move(thread));
  }
  reset();
}

void ThreadBodies::reset() {
  for (Thread& thread : threads_) {
    thread.chain.reset();
    thread.around.touches.clear();
    thread.around.holds.resize(thread.fixed_holds);
  }
  grips_ = {};
}

void ThreadBodies::step(const ToolMotions& motions, const ObstacleMotions& obstacles) {
  changeGrips(motions);
  if (!obstacles_.empty()) interpolateObstacles(obstacles_, obstacles, substeps_, tick_s_, ways_);
  for (int s = 0; s < substeps_; ++s) {
    const layout::ObstacleMotion* const ways =
        obstacles_.empty() ? nullptr : &ways_[static_cast<size_t>(s) * layout::kMaxObstacles];
    for (size_t t = 0; t < threads_.size(); ++t) substep(t, static_cast<double>(s + 1) / substeps_, motions, ways);
  }
}

/// A stylus in mode grab takes the nearest node within its reach, and the one behind it, when it begins.
void ThreadBodies::changeGrips(const ToolMotions& motions) {
  for (size_t s = 0; s < styluses_.size(); ++s) {
    const StylusMotion& motion = motions[s];
    Grip& grip = grips_[s];
    const bool grabs = motion.present && motion.mode == ToolMode::kGrab;
    if (!grabs || motion.hold_begins) grip.holds = false;
    if (grabs && motion.hold_begins) takeHold(grip, motion.from, styluses_[s].grab.radius_m);
  }
}

void ThreadBodies::takeHold(Grip& grip, const Pose& tip, double reach_m) const {
  double nearest_m = reach_m;
  for (uint32_t t = 0; t < threads_.size(); ++t) {
    const std::vector<Vector3d>& places = threads_[t].chain.places_m();
    for (uint32_t i = 0; i + 1 < places.size(); ++i) {
      const double distance_m = (places[i] - tip.position_m).norm();
      if (distance_m > nearest_m) continue;
      nearest_m = distance_m;
      grip = {t, i, true, {tip.inverse() * places[i], tip.inverse() * places[i + 1]}, {kRigidMass_kg, kRigidMass_kg}};
    }
  }
}

/// @param at  of the tick, at the end of the substep
void ThreadBodies::substep(size_t t, double at, const ToolMotions& motions, const layout::ObstacleMotion* obstacles) {
  Thread& thread = threads_[t];
  const double dt_s = tick_s_ / substeps_;
  const auto count = static_cast<uint32_t>(obstacles_.size());
  std::vector<ChainHold>& holds = thread.around.holds;
  holds.resize(thread.fixed_holds);
  for (size_t s = 0; s < styluses_.size(); ++s) {
    const Grip& grip = grips_[s];
    if (!grip.holds || grip.thread != t) continue;
    const Pose tip = interpolate(motions[s].from, motions[s].to, at);
    for (uint32_t k = 0; k < 2; ++k) {
      ChainHold hold = holdOf(grip.node + k, tip * grip.places_m[k]);
      hold.most_n = styluses_[s].max_force_n / 2;
      hold.stiffness_kg = grip.stiffness_kg[k];
      holds.push_back(hold);
    }
  }
  thread.touches.find(thread.chain, obstacles, count, dt_s, thread.around.touches);
  thread.around.entered = [&](const std::vector<Vector3d>& ends_m, std::vector<ChainTouch>& touches) {
    return thread.touches.catchUp(thread.chain, obstacles, count, dt_s, ends_m, touches);
  };
  thread.chain.step(dt_s, thread.around);
  size_t h = thread.fixed_holds;
  for (size_t s = 0; s < styluses_.size(); ++s) {
    Grip& grip = grips_[s];
    if (!grip.holds || grip.thread != t) continue;
    for (double& stiffness_kg : grip.stiffness_kg) stiffness_kg = holds[h++].stiffness_kg;
  }
}

void ThreadBodies::persist(Archive& archive) {
  archive.section("threads");
  for (Thread& thread : threads_) {
    thread.chain.persist(archive);
    archive.list(thread.around.touches);
    for (size_t h = 0; h < thread.fixed_holds; ++h) archive.value(thread.around.holds[h].stiffness_kg);
  }
  archive.value(grips_);
}

uint64_t ThreadBodies::hashWith(uint64_t tissue) const {
  StateHash hash;
  hash.add(static_cast<uint32_t>(tissue));
  hash.add(static_cast<uint32_t>(tissue >> 32));
  for (const Thread& thread : threads_) {
    for (size_t i = 0; i < thread.chain.nodes(); ++i) {
      for (const Vector3d& vector : {thread.chain.places_m()[i], thread.chain.velocities_m_per_s()[i]}) {
        for (const double part : vector) hash.add(static_cast<float>(part));
      }
    }
  }
  return hash.value();
}

}  // namespace viscera
