// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/simulator/simulation_loop.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "haptics/wrench_schedule.h"
#include "nodes/ros/thread_name.h"
#include "viscera/gpu/context.h"
#include "viscera/math/error.h"
#include "viscera/math/state_hash.h"

namespace viscera::nodes {
namespace {

constexpr std::chrono::milliseconds kIdlePeriod{20};  ///< period of zero forces while paused

double seconds(std::chrono::steady_clock::duration span) {
  return std::chrono::duration<double>(span).count();
}

/// Thrown when the model that is being created is not needed.
struct Stopped {};

CommandAnswer answer(bool success, const std::string& message, const Session& session) {
  CommandAnswer out;
  out.success = success;
  out.message = message;
  out.tick = session.tick();
  return out;
}

}  // namespace

SimulationLoop::SimulationLoop(const Scene& scene, std::unique_ptr<MadeSession> made, LoopPorts ports,
                               Progress progress)
    : scene_(scene),
      made_(made ? std::move(made) : std::make_unique<MadeSession>(scene)),
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
  nameThread("simulation");
  try {
    run();
  } catch (const Stopped&) {
  } catch (...) {
    error_ = std::current_exception();
    ports_.failed();
  }
  made_->give();
  commands_.close();
  ended_ = true;
}

void SimulationLoop::run() {
  made_->take();
  made_->makeRest([this](const std::string& stage, double fraction) {
    if (stop_) throw Stopped{};
    progress_(stage, fraction);
  });
  Session& session = *made_->session;
  {
    const std::lock_guard<std::mutex> lock(status_mutex_);
    status_.pictures = made_->context != nullptr;
    status_.gpu = status_.pictures ? made_->context->renderer() : "none: " + made_->no_context;
    status_.software_gpu = status_.pictures && made_->context->isSoftware();
    status_.backend = session.solver().backend();
    status_.stepped_by = session.backendNote();
  }
  ports_.ready(session, made_->context != nullptr);
  showSkin(session);
  while (!stop_) {
    while (std::optional<Command> command = commands_.take()) command->answer.set_value(execute(*command, session));
    if (paused_) {
      rest(session);
      commands_.wait(kIdlePeriod);
    } else {
      tick(session, ports_.samples(), true);
      std::this_thread::sleep_until(pacer_.next(Clock::now()));
    }
  }
  ports_.leave(session);
}

void SimulationLoop::tick(Session& session, const StylusSamples& samples, bool live) {
  const Clock::time_point begun = Clock::now();
  if (ports_.place) ports_.place(session);
  if (ports_.aim) ports_.aim(session);
  Frame frame = session.step(samples, drawable(ports_.outputs()));
  const Clock::time_point stepped = Clock::now();
  {
    const std::lock_guard<std::mutex> lock(status_mutex_);
    pace_.add(session.tick_s(), seconds(stepped - begun), seconds(stepped - tick_ended_));
  }
  tick_ended_ = stepped;
  ports_.stepped(session.tick(), samples, frame.tools, std::exchange(input_reset_, false));
  deliver(session, std::move(frame), samples, live);
}

FrameRequest SimulationLoop::drawable(const FrameRequest& outputs) const {
  if (made_->context) return outputs;
  FrameRequest out;
  out.surface = outputs.surface;
  return out;
}

/// Delivers the initial surface without images: drawing takes time, and they come with the first ticks.
void SimulationLoop::showSkin(Session& session) {
  Frame frame = session.drain();
  FrameRequest outputs;
  outputs.surface = ports_.stills(true, false).surface;
  if (outputs.surface) frame.surface = session.show(outputs).surface;
  deliver(session, std::move(frame), ports_.samples(), false);
  tick_ended_ = Clock::now();
  pacer_.restart(tick_ended_);
}

void SimulationLoop::rest(Session& session) {
  Frame frame = session.drain();
  const bool aimed = ports_.aim && ports_.aim(session);
  const FrameRequest outputs = drawable(ports_.stills(std::exchange(unseen_, false), aimed));
  if (outputs.count() > 0) {
    Pictures shown = session.show(outputs);
    if (shown.surface) frame.surface = std::move(shown.surface);
    std::move(shown.images.begin(), shown.images.end(), std::back_inserter(frame.images));
  }
  deliver(session, std::move(frame), stepped_to_ ? *stepped_to_ : ports_.samples(), false);
  tick_ended_ = Clock::now();
  pacer_.restart(tick_ended_);
}

void SimulationLoop::deliver(const Session& session, Frame&& frame, const StylusSamples& samples, bool live) {
  if (!live) frame.reactions = {};  // tissue that is paused or stepped by a command must not push
  {
    const std::lock_guard<std::mutex> lock(status_mutex_);
    ready_ = true;
    status_.paused = paused_;
    status_.dt_s = session.solver().dt_s();
    status_.dt_safe_s = session.solver().dtSafe_s();
    status_.dt_limit_s = session.solver().dtLimit_s();
    status_.tick = session.tick();
    status_.counters = session.counters();
    status_.reactions = frame.reactions;
    status_.stats = frame.stats;
    status_.health = frame.health;
    status_.speed_limited = frame.speed_limited;
    status_.inside = frame.inside;
    status_.shafts_touch = frame.shafts_touch;
    status_.facts = session.facts();
    status_.modes.clear();
    for (const StylusConfig& stylus : session.styluses())
      status_.modes.push_back({stylus.idle, stylus.button1, stylus.button2});
  }
  if (ports_.addTo) ports_.addTo(session, frame);
  ports_.deliver(std::move(frame), samples, live);
}

/// Discards stylus motion from before, or from a time without ticks: a blade would sweep through the tissue.
void SimulationLoop::resetInput(Session& session) {
  session.resetInput();
  input_reset_ = true;
  stepped_to_.reset();
  ports_.resetInput();
}

CommandAnswer SimulationLoop::execute(const Command& command, Session& session) {
  switch (command.kind) {
    case Command::Kind::kReset:
      ports_.rest();  // before anything that takes time, here and below, including an image of the state at rest
      session.reset();
      resetInput(session);
      unseen_ = true;
      return answer(true, "back to rest", session);
    case Command::Kind::kPause:
      if (paused_) return answer(false, "already paused", session);
      paused_ = true;
      ports_.rest();
      resetInput(session);
      return answer(true, "paused", session);
    case Command::Kind::kResume:
      if (!paused_) return answer(false, "not paused", session);
      paused_ = false;
      resetInput(session);
      return answer(true, "running", session);
    case Command::Kind::kOverlays:
      return setOverlays(command, session);
    case Command::Kind::kChange:
      return change(command, session);
    case Command::Kind::kStep:
      break;
  }
  return step(command, session);
}

CommandAnswer SimulationLoop::change(const Command& command, Session& session) {
  if (command.leaps) ports_.rest();
  bool done = false;
  std::string message;
  try {
    message = command.change(session);
    done = true;
  } catch (const Error& error) {
    message = error.what();
  }
  if (command.leaps) {
    resetInput(session);
    unseen_ = true;
  }
  return answer(done, message, session);
}

CommandAnswer SimulationLoop::setOverlays(const Command& command, Session& session) {
  const std::vector<CameraConfig>& cameras = session.scene().cameras;
  bool found = false;
  for (size_t c = 0; c < cameras.size(); ++c) {
    if (!command.camera.empty() && cameras[c].name != command.camera) continue;
    session.setOverlays(c, command.overlays);
    found = true;
  }
  if (!found) return answer(false, "camera: the scene has no camera '" + command.camera + "'", session);
  unseen_ = true;
  return answer(true, "applies from the next picture on", session);
}

StylusSamples SimulationLoop::samplesOf(const Command& command, uint32_t tick) const {
  if (!command.samples) return ports_.samples();
  StylusSamples samples = *command.samples;
  if (!stepped_to_) return samples;
  const double covered = static_cast<double>(tick + 1) / command.ticks;
  for (size_t s = 0; s < samples.size(); ++s) {
    if (samples[s].valid && (*stepped_to_)[s].valid)
      samples[s].pose = interpolate((*stepped_to_)[s].pose, samples[s].pose, covered);
  }
  return samples;
}

CommandAnswer SimulationLoop::step(const Command& command, Session& session) {
  if (!paused_) return answer(false, "not paused; call pause first", session);
  if (command.ticks > kMaxStepTicks) return answer(false, "ticks must be 0.." + std::to_string(kMaxStepTicks), session);
  uint32_t done = 0;
  StylusSamples last_samples;
  while (done < command.ticks && !stop_ && Clock::now() < command.deadline) {
    last_samples = samplesOf(command, done++);
    tick(session, last_samples, false);
  }
  if (command.samples && done > 0) stepped_to_ = last_samples;
  Frame last = session.drain();  // includes measurements of the last tick
  const Wrenches reactions = last.reactions;
  deliver(session, std::move(last), last_samples, false);
  unseen_ = unseen_ || done > 0;
  const bool all = done == command.ticks;
  CommandAnswer out =
      answer(all, all ? "" : "stopped at the time limit after " + std::to_string(done) + " ticks", session);
  out.state_hash = StateHash::text(session.stateHash());
  out.reactions.assign(reactions.begin(), reactions.begin() + static_cast<std::ptrdiff_t>(scene_.styluses.size()));
  return out;
}

std::optional<LoopStatus> SimulationLoop::takeStatus() {
  const std::lock_guard<std::mutex> lock(status_mutex_);
  if (!ready_) return std::nullopt;
  status_.pace = pace_.take();
  return status_;
}

}  // namespace viscera::nodes
