// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/simulation_loop.h"

#include <utility>

#include "viscera/gpu/context.h"
#include "viscera/math/state_hash.h"

namespace viscera::nodes {
namespace {

constexpr std::chrono::milliseconds kIdlePeriod{20};  ///< how often forces are re-sent as zero while paused

double seconds(std::chrono::steady_clock::duration span) {
  return std::chrono::duration<double>(span).count();
}

CommandAnswer answer(bool success, const std::string& message, const Session& session) {
  CommandAnswer out;
  out.success = success;
  out.message = message;
  out.tick = session.tick();
  return out;
}

}  // namespace

SimulationLoop::SimulationLoop(const Scene& scene, LoopPorts ports, Progress progress)
    : scene_(scene),
      ports_(std::move(ports)),
      progress_(std::move(progress)),
      pacer_(1.0 / scene.solver.tick_hz),
      thread_([this] { main(); }) {}

SimulationLoop::~SimulationLoop() {
  stop_ = true;
  commands_.close();
  if (thread_.joinable()) thread_.join();
}

void SimulationLoop::stop() {
  stop_ = true;
  commands_.close();
  if (thread_.joinable()) thread_.join();
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

void SimulationLoop::main() {
  try {
    run();
  } catch (...) {
    error_ = std::current_exception();
  }
  commands_.close();
  ended_ = true;
}

void SimulationLoop::run() {
  gpu::Context context(scene_.solver.device);
  Session session(scene_, context, progress_);
  {
    const std::lock_guard<std::mutex> lock(status_mutex_);
    status_.gpu = context.renderer();
    status_.software_gpu = context.isSoftware();
    status_.backend = session.solver().backend();
  }
  ports_.ready(session);
  rest(session);
  while (!stop_) {
    while (std::optional<Command> command = commands_.take()) command->answer.set_value(execute(*command, session));
    if (paused_) {
      rest(session);
      commands_.wait(kIdlePeriod);
    } else {
      tick(session);
      std::this_thread::sleep_until(pacer_.next(Clock::now()));
    }
  }
}

void SimulationLoop::tick(Session& session) {
  const Clock::time_point begun = Clock::now();
  if (ports_.place) ports_.place(session);
  Frame frame = session.step(ports_.samples(), ports_.wants());
  const Clock::time_point stepped = Clock::now();
  {
    const std::lock_guard<std::mutex> lock(status_mutex_);
    pace_.add(session.tick_s(), seconds(stepped - begun), seconds(stepped - tick_ended_));
  }
  tick_ended_ = stepped;
  deliver(session, std::move(frame));
}

void SimulationLoop::rest(Session& session) {
  Frame frame = session.drain();
  frame.reactions = {};  // tissue that stands still must not push
  deliver(session, std::move(frame));
  tick_ended_ = Clock::now();
  pacer_.restart(tick_ended_);
}

void SimulationLoop::deliver(const Session& session, Frame&& frame) {
  {
    const std::lock_guard<std::mutex> lock(status_mutex_);
    ready_ = true;
    status_.paused = paused_;
    status_.dt_s = session.solver().dt_s();
    status_.dt_safe_s = session.solver().dtSafe_s();
    status_.tick = session.tick();
    status_.counters = session.counters();
    status_.reactions = frame.reactions;
    status_.stats = frame.stats;
    status_.health = frame.health;
    status_.held_back = frame.held_back;
  }
  ports_.deliver(std::move(frame));
}

CommandAnswer SimulationLoop::execute(const Command& command, Session& session) {
  switch (command.kind) {
    case Command::Kind::kReset:
      session.reset();
      return answer(true, "back to rest", session);
    case Command::Kind::kPause:
      if (paused_) return answer(false, "already paused", session);
      paused_ = true;
      return answer(true, "paused", session);
    case Command::Kind::kResume:
      if (!paused_) return answer(false, "not paused", session);
      paused_ = false;
      return answer(true, "running", session);
    case Command::Kind::kStep:
      break;
  }
  return step(command, session);
}

CommandAnswer SimulationLoop::step(const Command& command, Session& session) {
  if (!paused_) return answer(false, "not paused: call pause first", session);
  if (command.ticks > kMaxStepTicks) return answer(false, "ticks must be 0.." + std::to_string(kMaxStepTicks), session);
  bool in_time = true;
  for (uint32_t i = 0; i < command.ticks && in_time; ++i) {
    tick(session);
    in_time = !stop_ && Clock::now() < command.deadline;
  }
  CommandAnswer out = answer(in_time, in_time ? "" : "stopped at the time limit", session);
  out.state_hash = StateHash::text(session.stateHash());
  return out;
}

std::optional<LoopStatus> SimulationLoop::takeStatus() {
  const std::lock_guard<std::mutex> lock(status_mutex_);
  if (!ready_) return std::nullopt;
  status_.pace = pace_.take();
  return status_;
}

}  // namespace viscera::nodes
