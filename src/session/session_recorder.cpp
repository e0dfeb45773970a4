// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "session/session_recorder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "session/session_recording.h"

namespace viscera {

namespace {

// Interval of states from which a replay can begin. It is as short as possible for a recording of an hour to stay below
// 200 MB, including the input of the tools, about 70 MB for two of them before compression.
constexpr double kStateEvery_s = 10;
constexpr double kStateBytesPerS = 30e3;

}  // namespace

void SessionRecorder::follow(Session& session) {
  leave();
  session_ = &session;
  file_.put(ChunkKind::kScene, RecordedScene::of(session.scene(), session.backendNote()).bytes());
  putState(session, true);
  for (size_t c = 0; c < session.scene().cameras.size(); ++c) overlaysSet(c, session.overlays(c));
  session.addLog(*this);
}

void SessionRecorder::leave() {
  if (!session_) return;
  Archive all;
  session_->save(all);  // waits for measurements, and leaves images in flight
  session_->removeLog(*this);
  RecordedState end;
  end.tick = session_->tick();
  end.hash = session_->stateHash();
  file_.put(ChunkKind::kEnd, end.bytes());
  session_ = nullptr;
}

void SessionRecorder::put(SessionEvent& event) {
  Archive archive;
  archive.section("events");
  event.persist(archive, session_->scene().styluses.size());
  file_.put(ChunkKind::kEvents, std::move(archive.take()[0].bytes));
}

void SessionRecorder::putState(Session& session, bool leaps) {
  Archive archive;
  session.save(archive);
  RecordedState state{leaps, session.tick(), session.stateHash(), archive.take()};
  file_.put(ChunkKind::kState, state.bytes());
  steps_since_state_ = 0;
}

void SessionRecorder::stepped(Session& session, const StylusSamples& samples) {
  SessionEvent event;
  event.samples = samples;
  put(event);
  const double every_s = std::max(kStateEvery_s, static_cast<double>(file_.lastStateBytes()) / kStateBytesPerS);
  if (static_cast<double>(++steps_since_state_) * session.tick_s() >= every_s) putState(session, false);
}

void SessionRecorder::measured(const Session&, uint64_t tick, const layout::TickStats& stats) {
  SessionEvent event;
  event.kind = SessionEvent::Kind::kMeasured;
  event.tick = tick;
  event.measured = fingerprintOf(stats);
  put(event);
}

void SessionRecorder::wasReset() {
  SessionEvent event;
  event.kind = SessionEvent::Kind::kReset;
  put(event);
}

void SessionRecorder::inputCleared() {
  SessionEvent event;
  event.kind = SessionEvent::Kind::kClearInput;
  put(event);
}

void SessionRecorder::restored(Session& session) {
  putState(session, true);
}

void SessionRecorder::toolModeSet(size_t stylus, ToolSwitch when, ToolMode mode) {
  SessionEvent event;
  event.kind = SessionEvent::Kind::kToolMode;
  event.index = static_cast<uint32_t>(stylus);
  event.when = when;
  event.mode = mode;
  put(event);
}

void SessionRecorder::forceLimitsSet(size_t stylus, const ForceLimits& limits) {
  SessionEvent event;
  event.kind = SessionEvent::Kind::kForceLimits;
  event.index = static_cast<uint32_t>(stylus);
  event.limits = limits;
  put(event);
}

void SessionRecorder::obstacleFrameSet(size_t obstacle, const Pose& pose) {
  SessionEvent event;
  event.kind = SessionEvent::Kind::kObstacleFrame;
  event.index = static_cast<uint32_t>(obstacle);
  event.pose = pose;
  put(event);
}

void SessionRecorder::cameraFrameSet(size_t camera, const Pose& pose) {
  SessionEvent event;
  event.kind = SessionEvent::Kind::kCameraFrame;
  event.index = static_cast<uint32_t>(camera);
  event.pose = pose;
  put(event);
}

void SessionRecorder::sutureTied(size_t piece, const SutureTie& tie) {
  SessionEvent event;
  event.kind = SessionEvent::Kind::kTie;
  event.index = static_cast<uint32_t>(piece);
  event.tie = tie;
  put(event);
}

void SessionRecorder::taskRecorded(Session&, const std::string& name, const std::string& yaml) {
  SessionEvent event;
  event.kind = SessionEvent::Kind::kTask;
  event.task = name;
  event.task_yaml = yaml;
  put(event);
}

void SessionRecorder::overlaysSet(size_t camera, const Overlays& overlays) {
  SessionEvent event;
  event.kind = SessionEvent::Kind::kOverlays;
  event.index = static_cast<uint32_t>(camera);
  event.overlays = overlays;
  put(event);
}

}  // namespace viscera
