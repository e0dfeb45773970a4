// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/thread/thread_bodies.h"

#include <algorithm>
#include <cmath>

#include "solver/thread/thread_shape.h"
#include "viscera/math/state_hash.h"

namespace viscera {

namespace {

constexpr double kThreadSubstep_s = 5e-4;

}  // namespace

ThreadBodies::ThreadBodies(const Scene& scene, int good_states)
    : obstacles_(scene.obstacles),
      tick_s_(1 / scene.solver.tick_hz),
      hands_(scene.styluses),
      good_states_(static_cast<size_t>(good_states)) {
  for (const ThreadConfig& config : scene.threads) {
    Thread thread{Chain(materialOf(config), placesOf(config)), {}, 0, {}};
    const auto last = static_cast<uint32_t>(thread.chain.nodes() - 1);
    for (const uint32_t node : {0U, last}) {
      if ((node == 0 ? config.start : config.end) == ThreadEnd::kFree) continue;
      thread.around.holds.emplace_back();
      thread.around.holds.back().node = node;
      thread.around.holds.back().to_m = thread.chain.places_m()[node];
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
  hands_.reset();
}

void ThreadBodies::plan(Steps& steps, int count, const ObstacleMotions& obstacles) const {
  steps.count = count;
  if (!obstacles_.empty()) interpolateObstacles(obstacles_, obstacles, count, tick_s_, steps.ways);
}

void ThreadBodies::beginTick(const ToolMotions& motions, const ObstacleMotions& obstacles, int /*substeps*/) {
  std::vector<const Chain*> chains;
  for (const Thread& thread : threads_) chains.push_back(&thread.chain);
  hands_.beginTick(motions, chains);
  plan(alone_, static_cast<int>(std::ceil(tick_s_ / kThreadSubstep_s)), obstacles);
  work_j_ = 0;
}

void ThreadBodies::act(BladeTarget& /*target*/, int /*substep*/) {}

void ThreadBodies::endTick() {
  for (int s = 0; s < alone_.count; ++s) {
    for (uint32_t t = 0; t < threads_.size(); ++t) substep(t, alone_, s);
  }
}

void ThreadBodies::step(const ToolMotions& motions, const ObstacleMotions& obstacles) {
  beginTick(motions, obstacles, 0);
  endTick();
}

void ThreadBodies::substep(uint32_t t, const Steps& steps, int index) {
  Thread& thread = threads_[t];
  const double dt_s = tick_s_ / steps.count;
  const auto count = static_cast<uint32_t>(obstacles_.size());
  const layout::ObstacleMotion* const obstacles =
      count == 0 ? nullptr : &steps.ways[static_cast<size_t>(index) * layout::kMaxObstacles];
  std::vector<ChainHold>& holds = thread.around.holds;
  holds.resize(thread.fixed_holds);
  hands_.addHolds(t, static_cast<double>(index + 1) / steps.count, holds);
  thread.touches.find(thread.chain, obstacles, count, dt_s, thread.around.touches);
  thread.around.entered = [&](const std::vector<Vector3d>& ends_m, std::vector<ChainTouch>& touches) {
    return thread.touches.catchUp(thread.chain, obstacles, count, dt_s, ends_m, touches);
  };
  thread.chain.step(dt_s, thread.around);
  hands_.takeOver(t, holds, thread.fixed_holds);
}

void ThreadBodies::persist(Archive& archive) {
  archive.section("threads");
  persistMotion(archive);
  hands_.persist(archive);
  uint64_t kept = good_.size();
  archive.value(kept);
  good_.resize(kept);
  for (std::vector<Archive::Section>& state : good_) {
    if (archive.reads()) state.assign(1, {});
    archive.list(state[0].bytes);
  }
}

/// What rollbacks put back.
void ThreadBodies::persistMotion(Archive& archive) {
  for (Thread& thread : threads_) {
    thread.chain.persist(archive);
    archive.list(thread.around.touches);
    for (size_t h = 0; h < thread.fixed_holds; ++h) archive.value(thread.around.holds[h].stiffness_kg);
  }
}

void ThreadBodies::saveGood() {
  Archive archive;
  archive.section({});
  persistMotion(archive);
  if (good_.size() == good_states_) good_.erase(good_.begin());
  good_.push_back(archive.sections());
}

void ThreadBodies::restoreGood(int back) {
  const size_t most = good_.size() - 1, wanted = static_cast<size_t>(back);
  good_.resize(good_.size() - std::min(wanted, most));
  Archive archive(good_.back());
  archive.section({});
  persistMotion(archive);
  if (wanted <= most) return;
  for (Thread& thread : threads_) thread.chain.stop();
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
