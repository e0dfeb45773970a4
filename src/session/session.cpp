// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/session/session.h"

#include <algorithm>
#include <cmath>

#include "math/float_bits.h"
#include "session/view.h"
#include "solver/make_solver.h"
#include "viscera/calibration/auto_spacing.h"

namespace viscera {

namespace {

constexpr size_t kNotedTicks = 4096;  // images may come back that late

Vector3d xyz(const layout::vec4& v) {
  return {v.x, v.y, v.z};
}

}  // namespace

Session::Session(const Scene& scene, gpu::Context& context, const Progress& progress, const SessionOptions& options)
    : Session(scene, &context, progress, options) {}

Session::Session(const Scene& scene, const Progress& progress, const SessionOptions& options)
    : Session(scene, nullptr, progress, options) {}

/// @param context  null: there is none
Session::Session(const Scene& scene, gpu::Context* context, const Progress& progress, const SessionOptions& options)
    : scene_(withChosenSpacing(scene, context, progress)),
      model_(buildModel(scene_, progress)),
      tools_(scene.styluses, waveSpeed(model_) / scene.solver.tick_hz),
      obstacles_(scene.obstacles),
      pose_times_(kNotedTicks) {
  solver_ = makeSolver(model_, scene_, context, options.threads);
  backend_note_ = viscera::backendNote(scene_.solver, context, *solver_);
  view_ = makeView(*solver_, model_, scene_, context);
  lookAtObstacles();
  for (const StylusConfig& stylus : scene_.styluses) {
    limiters_.emplace_back(stylus.max_force_n, stylus.max_force_rate_n_per_s);
  }
}

Session::~Session() = default;

Frame Session::step(const StylusSamples& samples, const Wants& wants) {
  moveObstacles();
  look_.motions = tools_.advance(samples);             // VR05 2.7: probe, grab, cut
  solver_->step(look_.motions, obstacles_.motions());  // VR05 2.4: n substeps
  look_.tick = ++tick_;
  look_.wants = wants;
  ++ticks_;
  notePoses(samples);
  Frame frame;
  view_->capture(*solver_, look_, frame);  // EGVE 3.3: nodes -> vertices, only what is wanted
  collect(frame, false);
  releaseUntracked(look_.motions, frame);
  return frame;
}

void Session::setObstacleFrame(size_t obstacle, const Pose& pose) {
  obstacles_.setFrame(obstacle, pose);
}

void Session::moveObstacles() {
  obstacles_.advance(time_s_, tick_s());
  time_s_ += tick_s();
  lookAtObstacles();
}

void Session::lookAtObstacles() {
  look_.obstacles.clear();
  for (size_t i = 0; i < obstacles_.count(); ++i) look_.obstacles.push_back(obstacles_.pose(i));
}

/// No pose, or tissue that is not itself: no force, at once.
void Session::releaseUntracked(const ToolMotions& motions, Frame& frame) {
  for (size_t s = 0; s < limiters_.size(); ++s) {
    frame.held_back[s] = motions[s].held_back;
    extremes_.held_back += motions[s].held_back;
    if (motions[s].present && !frame.health.recovering) continue;
    limiters_[s].reset();
    frame.reactions[s] = Reaction{};
  }
}

SteadyTime Session::PoseTimes::newest() const {
  return *std::max_element(received.begin(), received.end());
}

void Session::notePoses(const StylusSamples& samples) {
  PoseTimes& times = pose_times_[tick_ % kNotedTicks];
  times.tick = tick_;
  for (size_t s = 0; s < samples.size(); ++s) times.received[s] = samples[s].valid ? samples[s].received : SteadyTime{};
}

Session::PoseTimes Session::posesOf(uint64_t tick) const {
  const PoseTimes& times = pose_times_[tick % kNotedTicks];
  return times.tick == tick ? times : PoseTimes{};
}

void Session::collect(Frame& frame, bool wait) {
  frame.tick = tick_;
  frame.tools = look_.motions;
  frame.obstacles = look_.obstacles;
  collectStats(frame, wait);
  view_->collect(frame, wait);
  if (frame.surface) frame.surface->pose_received = posesOf(frame.surface->tick).newest();
  for (ImageFrame& image : frame.images) image.pose_received = posesOf(image.tick).newest();
}

void Session::collectStats(Frame& frame, bool wait) {
  while (solver_->pollStats(stats_, wait)) {
    has_stats_ = true;
    ++judged_;
    for (size_t s = 0; s < limiters_.size(); ++s) {
      // Force on a tool: minus the momentum it gave the nodes, per tick (physics.md 5).
      const Reaction raw{-xyz(stats_.impulse[s]) / tick_s(), -xyz(stats_.angular[s]) / tick_s(), false};
      extremes_.peak_force_n = std::max(extremes_.peak_force_n, raw.force_n.norm());
      reactions_[s] = limiters_[s].limit(raw, tick_s());
    }
    extremes_.max_stretch =
        std::max(extremes_.max_stretch, static_cast<double>(floatFromBits(stats_.max_stretch_bits)));
    extremes_.max_speed_m_per_s =
        std::max(extremes_.max_speed_m_per_s, static_cast<double>(floatFromBits(stats_.max_speed_bits)));
    extremes_.nonfinite = std::max<uint64_t>(extremes_.nonfinite, stats_.nonfinite);
  }
  frame.health = solver_->health();
  extremes_.governor_trips = frame.health.trips;
  frame.stats = stats_;
  frame.has_stats = has_stats_;
  frame.reactions = reactions_;
  frame.poses_received = posesOf(judged_).received;
}

void Session::reset() {
  drain();
  solver_->reset();
  view_->reset();
  tools_.reset();
  obstacles_.reset();
  look_.motions = {};
  lookAtObstacles();
  for (ForceLimiter& limiter : limiters_) limiter.reset();
  reactions_ = {};
  stats_ = {};
  has_stats_ = false;
  extremes_ = {};
  tick_ = judged_ = 0;
  time_s_ = 0;
  std::fill(pose_times_.begin(), pose_times_.end(), PoseTimes{});
}

Frame Session::drain() {
  Frame frame;
  collect(frame, true);
  return frame;
}

uint64_t Session::stateHash() const {
  return viscera::stateHash(model_, solver_->readState());
}

std::shared_ptr<const ShownTopology> Session::wholeSkin() const {
  return view_->wholeSkin();
}

Counters Session::counters() const {
  Counters out;
  static_cast<ViewCounters&>(out) = view_->counters();
  out.ticks = ticks_;
  out.substeps = solver_->substepsDone();
  return out;
}

bool Session::imageDue(size_t camera) const {
  const double per_tick = scene_.cameras[camera].rate_hz * tick_s();
  return std::floor(static_cast<double>(tick_ + 1) * per_tick) != std::floor(static_cast<double>(tick_) * per_tick);
}

}  // namespace viscera
