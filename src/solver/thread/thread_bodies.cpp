// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/thread/thread_bodies.h"

#include <algorithm>
#include <cmath>

#include "model/fracture/tearing.h"
#include "solver/thread/thread_shape.h"
#include "viscera/math/state_hash.h"

namespace viscera {

namespace {

constexpr double kThreadSubstep_s = 5e-4;

}  // namespace

ThreadBodies::ThreadBodies(const Scene& scene, const Model* model, int good_states)
    : obstacles_(scene.obstacles),
      tick_s_(1 / scene.solver.tick_hz),
      can_cut_(threadsTear(scene)),
      hands_(scene.styluses),
      good_states_(static_cast<size_t>(good_states)) {
  const bool tied = std::any_of(scene.threads.begin(), scene.threads.end(),
                                [](const ThreadConfig& config) { return config.feelsTissue(); });
  if (model && tied) {
    tissue_ = std::make_unique<TissuePoints>(*model);
    needles_.emplace(scene, *model);
  }
  for (const ThreadConfig& config : scene.threads) {
    Thread thread{Chain(materialOf(config), placesOf(config)), {}, 0, {}, {}, {}, {}};
    const auto last = static_cast<uint32_t>(thread.chain.nodes() - 1);
    for (const uint32_t node : {0U, last}) {
      const bool on_needle = node == 0 && needle(threads_.size());
      if (!on_needle && (node == 0 ? config.start : config.end) == ThreadEnd::kFree) continue;
      thread.around.holds.emplace_back();
      thread.around.holds.back().node = node;
      thread.around.holds.back().to_m = thread.chain.places_m()[node];
    }
    thread.fixed_holds = thread.around.holds.size();
    thread.around.gravity_m_per_s2 = scene.environment.gravity_m_per_s2;
    thread.around.swaged[0] = needle(threads_.size()) != nullptr;
    if (tissue_) thread.first_channels.lay(config, thread.chain, *model, *tissue_, thread.first_slides);
    threads_.push_back(std::move(thread));
  }
  reset();
}

void ThreadBodies::reset() {
  for (Thread& thread : threads_) {
    thread.chain.reset();
    thread.around.touches.clear();
    thread.around.holds.resize(thread.fixed_holds);
    thread.channels = thread.first_channels;
    thread.around.slides = thread.first_slides;
  }
  hands_.reset();
  if (needles_) needles_->reset();
}

void ThreadBodies::plan(Steps& steps, int count, const ObstacleMotions& obstacles) const {
  steps.count = count;
  if (!obstacles_.empty()) interpolateObstacles(obstacles_, obstacles, count, tick_s_, steps.ways);
}

void ThreadBodies::setCuts(const Model& model, const CutSprings& cuts) {
  tissue_->setCuts(cuts);
  lips_.find(model, cuts);
  for (Thread& thread : threads_) thread.channels.embedAgain(*tissue_, thread.around.slides);
  needles_->embedAgain(*tissue_);
}

void ThreadBodies::beginTick(const ToolMotions& motions, const ObstacleMotions& obstacles, int substeps) {
  std::vector<const Chain*> chains;
  for (const Thread& thread : threads_) chains.push_back(&thread.chain);
  hands_.beginTick(motions, chains);
  bool any = false;
  for (size_t t = 0; t < threads_.size(); ++t)
    any |= threads_[t].tied = tissue_ && (!threads_[t].channels.empty() || needle(t));
  if (any) {
    per_substep_ = static_cast<int>(std::ceil(tick_s_ / substeps / kThreadSubstep_s));
    plan(tied_, substeps * per_substep_, obstacles);
  }
  plan(alone_, static_cast<int>(std::ceil(tick_s_ / kThreadSubstep_s)), obstacles);
  work_j_ = 0;
  if (needles_) needles_->beginTick(motions);
}

std::vector<const TissuePoint*> ThreadBodies::tiedPoints() const {
  std::vector<const TissuePoint*> out;
  for (const Thread& thread : threads_) {
    if (thread.tied) thread.channels.addPoints(out);
  }
  if (!out.empty()) lips_.addPoints(out);
  return out;
}

/// What their tails leave becomes channels of their threads.
void ThreadBodies::moveNeedles(BladeTarget& target, int index) {
  if (!needles_ || needles_->empty()) return;
  const int last = (index + 1) * per_substep_;
  const double share = 1.0 / tied_.count, before_j = needles_->work_j();
  needles_->act(target, *tissue_, last * share, per_substep_ * share * tick_s_, obstaclesOf(tied_, last - 1),
                static_cast<uint32_t>(obstacles_.size()),
                [this](uint32_t t, const NeedlePassed& passed, const ChannelLaw& law) {
                  Thread& thread = threads_[t];
                  thread.channels.take(passed.point, law, passed.beyond_m / thread.chain.link_m(), *tissue_,
                                       thread.around.slides);
                });
  work_j_ += needles_->work_j() - before_j;
}

/// Where a substep of the tissue is longer than threads bear, they go through it with the speeds at its end.
bool ThreadBodies::act(BladeTarget& target, int index) {
  moveNeedles(target, index);
  if (std::none_of(threads_.begin(), threads_.end(), [](const Thread& thread) { return thread.tied; })) return false;
  const std::vector<const TissuePoint*> points = tiedPoints();
  const double dt_s = tick_s_ / tied_.count;
  tissue_->read(target, points);
  tissue_->drift((1 - per_substep_) * dt_s);
  for (int s = 0; s < per_substep_; ++s) {
    if (s > 0) tissue_->drift(dt_s);
    for (uint32_t t = 0; t < threads_.size(); ++t) {
      if (threads_[t].tied) substep(t, tied_, index * per_substep_ + s);
    }
  }
  lips_.part(*tissue_, per_substep_ * dt_s);
  tissue_->write(target, layout::kMaxStyluses, per_substep_ * dt_s);
  work_j_ += tissue_->work_j();
  bool cut = false;
  for (Thread& thread : threads_) {
    if (thread.tied) cut |= thread.channels.end(*tissue_, target, can_cut_, thread.around.slides);
  }
  return cut;
}

void ThreadBodies::endTick() {
  for (int s = 0; s < alone_.count; ++s) {
    for (uint32_t t = 0; t < threads_.size(); ++t) {
      if (!threads_[t].tied) substep(t, alone_, s);
    }
  }
}

ThreadPulls ThreadBodies::pulls() const {
  ThreadPulls out = hands_.pulls();
  for (size_t s = 0; s < out.size() && needles_; ++s) {
    out[s].impulse_ns += needles_->pulls()[s].impulse_ns;
    out[s].moment_nms += needles_->pulls()[s].moment_nms;
    out[s].nodes += needles_->pulls()[s].nodes;
  }
  return out;
}

const layout::ObstacleMotion* ThreadBodies::obstaclesOf(const Steps& steps, int index) const {
  return obstacles_.empty() ? nullptr : &steps.ways[static_cast<size_t>(index) * layout::kMaxObstacles];
}

void ThreadBodies::step(const ToolMotions& motions, const ObstacleMotions& obstacles) {
  beginTick(motions, obstacles, 1);
  endTick();
}

void ThreadBodies::substep(uint32_t t, const Steps& steps, int index) {
  Thread& thread = threads_[t];
  const double dt_s = tick_s_ / steps.count;
  const auto count = static_cast<uint32_t>(obstacles_.size());
  const layout::ObstacleMotion* const obstacles = obstaclesOf(steps, index);
  const bool on_needle = thread.tied && needle(t);
  std::vector<ChainHold>& holds = thread.around.holds;
  holds.resize(thread.fixed_holds);
  if (on_needle) needles_->lay(t, (index % per_substep_ + 1.0) / per_substep_, holds[0]);
  hands_.addHolds(t, static_cast<double>(index + 1) / steps.count, holds);
  thread.touches.find(thread.chain, obstacles, count, dt_s, thread.around.touches);
  thread.around.entered = [&](const std::vector<Vector3d>& ends_m, std::vector<ChainTouch>& touches) {
    return thread.touches.catchUp(thread.chain, obstacles, count, dt_s, ends_m, touches);
  };
  if (thread.tied) {
    thread.channels.begin(*tissue_, thread.around.slides);
    thread.around.answer = [&](std::vector<ChainSlide>& slides) { thread.channels.answer(*tissue_, dt_s, slides); };
  }
  thread.chain.step(dt_s, thread.around);
  if (thread.tied) thread.channels.note(thread.around.slides);
  hands_.takeOver(t, holds, thread.fixed_holds);
  if (on_needle) needles_->takeOver(t, holds[0]);
}

void ThreadBodies::persist(Archive& archive) {
  archive.section("threads");
  persistMotion(archive);
  hands_.persist(archive);
  if (needles_) needles_->persistHands(archive);
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
    archive.list(thread.around.slides);
    thread.channels.persist(archive);
    for (size_t h = 0; h < thread.fixed_holds; ++h) archive.value(thread.around.holds[h].stiffness_kg);
  }
  if (needles_) needles_->persist(archive);
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
    for (const ChainSlide& slide : thread.around.slides) hash.add(static_cast<float>(slide.s));
  }
  if (needles_) needles_->addTo(hash);
  return hash.value();
}

}  // namespace viscera
