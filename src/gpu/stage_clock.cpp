// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "gpu/stage_clock.h"

#include <chrono>

#include "gpu/fence.h"
#include "gpu/gl.h"
#include "viscera/math/error.h"

namespace viscera::gpu {

namespace {

constexpr double kSecondsPerTick = 1e-9;  // of GL_TIMESTAMP
constexpr size_t kDeepest = 8;            // stages within stages

thread_local StageClock* clock_of_thread = nullptr;

}  // namespace

const char* stageName(Stage stage) {
  constexpr const char* kNames[kStages] = {"cells",   "step",    "cut",      "measure", "reaction", "upload",
                                           "surface", "normals", "mapping",  "render",  "tissue",   "light",
                                           "edges",   "tools",   "overlays", "resolve", "read-back"};
  return kNames[static_cast<size_t>(stage)];
}

StageClock::StageClock(int marks) : marks_(static_cast<size_t>(marks)) {
  if (clock_of_thread) throw GpuError("a StageClock lives on this thread already");
  for (Mark& mark : marks_) {
    glCreateQueries(GL_TIMESTAMP, 1, &mark.query);
    countObject();
  }
  stack_.reserve(kDeepest);
  clock_of_thread = this;
}

std::unique_ptr<StageClock> StageClock::waiting() {
  auto clock = std::make_unique<StageClock>(0);
  clock->waits_ = true;
  return clock;
}

StageClock::~StageClock() {
  clock_of_thread = nullptr;
  for (Mark& mark : marks_) glDeleteQueries(1, &mark.query);
}

/// Waits for the GPU and ends the previous stage.
void StageClock::waitAndCount(int next) {
  glFinish();
  const SteadyTime now = std::chrono::steady_clock::now();
  if (last_stage_ != kNothing)
    times_[static_cast<size_t>(last_stage_)].seconds += std::chrono::duration<double>(now - last_).count();
  last_ = now;
  last_stage_ = next;
}

void StageClock::mark(int stage) {
  if (waits_) return waitAndCount(stage);
  Mark& mark = marks_[(oldest_ + in_flight_) % marks_.size()];
  ++in_flight_;
  mark.stage = stage;
  glQueryCounter(mark.query, GL_TIMESTAMP);
}

/// Enters a stage. Returns false if there is no room for the marks of its beginning and end, and of the ends of the
/// stages around it.
bool StageClock::enter(Stage stage) {
  const size_t needed = waits_ ? 0 : stack_.size() + 2;
  while (marks_.size() - in_flight_ < needed && readOldest(false)) {
  }
  if (marks_.size() - in_flight_ < needed) {
    ++untimed_;
    return false;
  }
  stack_.push_back(static_cast<int>(stage));
  ++times_[static_cast<size_t>(stage)].count;
  mark(stack_.back());
  return true;
}

void StageClock::leave() {
  stack_.pop_back();
  mark(stack_.empty() ? kNothing : stack_.back());
}

bool StageClock::readOldest(bool wait) {
  if (in_flight_ == 0) return false;
  const Mark& mark = marks_[oldest_];
  GLint there = 0;
  if (!wait) glGetQueryObjectiv(mark.query, GL_QUERY_RESULT_AVAILABLE, &there);
  if (!wait && !there) return false;
  GLuint64 now_ns = 0;
  glGetQueryObjectui64v(mark.query, GL_QUERY_RESULT, &now_ns);
  if (last_stage_ != kNothing) {
    times_[static_cast<size_t>(last_stage_)].seconds += kSecondsPerTick * static_cast<double>(now_ns - last_ns_);
  }
  last_ns_ = now_ns;
  last_stage_ = mark.stage;
  oldest_ = (oldest_ + 1) % marks_.size();
  --in_flight_;
  return true;
}

const std::array<StageClock::Time, kStages>& StageClock::collect(bool wait) {
  if (wait && in_flight_ > 0) awaitGpu("time stamps of its stages");
  while (readOldest(wait)) {
  }
  return times_;
}

TimedStage::TimedStage(Stage stage) : clock_(clock_of_thread) {
  if (clock_ && !clock_->enter(stage)) clock_ = nullptr;
}

TimedStage::~TimedStage() {
  if (clock_) clock_->leave();
}

}  // namespace viscera::gpu
