// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "nodes/ros/pace_meter.h"
#include "nodes/ros/pacer.h"
#include "nodes/simulator/command_queue.h"
#include "nodes/simulator/made_session.h"
#include "viscera/session/session.h"

namespace viscera::nodes {

/// State of the simulation, copied for the diagnostics.
struct LoopStatus {
  std::string gpu, backend, stepped_by;
  bool software_gpu = false;
  bool pictures = true;  ///< whether there is OpenGL to draw images
  bool paused = false;
  double dt_s = 0, dt_safe_s = 0, dt_limit_s = 0;
  uint64_t tick = 0;
  Counters counters;
  layout::TickStats stats{};
  Health health;
  std::array<bool, layout::kMaxStyluses> speed_limited{}, inside{};
  bool shafts_touch = false;
  std::array<Reaction, layout::kMaxStyluses> reactions;
  /// [styluses] tool modes: without buttons, with button 1, with button 2
  std::vector<std::array<ToolMode, 3>> modes;
  FactGroups facts;         ///< facts of processes in the tissue
  PaceMeter::Reading pace;  ///< pace since the last LoopStatus was taken
};

/// Callbacks of the loop, called on its own thread. None of them may block.
struct LoopPorts {
  std::function<void(Session&)> place;  ///< sets poses of carried obstacles for the tick that begins; may be null
  /// Sets poses of carried cameras, also while paused. @returns whether one has moved; may be null
  std::function<bool(Session&)> aim;
  std::function<StylusSamples()> samples;             ///< returns the samples for that tick
  std::function<FrameRequest()> outputs;              ///< returns the outputs of that tick
  std::function<void(const Session&, Frame&)> addTo;  ///< adds to a frame before it is delivered; may be null
  /// Runs once, before the first tick. @param pictures  whether there is OpenGL to draw images
  std::function<void(Session&, bool pictures)> ready;
  std::function<void(const Session&)> leave;  ///< called once, after the last tick, if there is a session
  /// Receives every tick. @param input_reset  whether input was discarded before the tick
  std::function<void(uint64_t tick, const StylusSamples&, const ToolMotions&, bool input_reset)> stepped;
  /// Receives the results of a tick with these samples.
  /// @param live  whether tissue follows the styluses: forces may be sent
  std::function<void(Frame&&, const StylusSamples&, bool live)> deliver;
  /// Returns the outputs of a state that does not advance. @param changed  the state changed since it was last shown
  /// @param aimed  a camera has moved since its images were last shown
  std::function<FrameRequest(bool changed, bool aimed)> stills;
  std::function<void()> rest;        ///< stops forces at once, until a live tick is delivered
  std::function<void()> resetInput;  ///< discards device input: styluses were not followed, or will not be
  std::function<void()> failed;      ///< called when an error has ended the thread
};

/// Runs the session, with its OpenGL context, on a thread of its own that is paced by the steady clock.
class SimulationLoop {
 public:
  /// Largest number of ticks of one step command.
  static constexpr uint32_t kMaxStepTicks = 10000;

  /// @param made  the session of the scene, or as much of it as was created in advance; null: none
  SimulationLoop(const Scene& scene, std::unique_ptr<MadeSession> made, LoopPorts ports, Progress progress);
  ~SimulationLoop();
  SimulationLoop(const SimulationLoop&) = delete;
  SimulationLoop& operator=(const SimulationLoop&) = delete;

  /// Returns whether the thread has ended: by stop(), or by an error that stop() will rethrow.
  bool ended() const { return ended_; }
  /// Ends the thread. @throws the error that ended it, if any
  void stop();
  /// Returns the session of a thread that has ended, so that the caller destroys it later.
  std::unique_ptr<MadeSession> takeSession() { return std::move(made_); }

  CommandQueue& commands() { return commands_; }
  /// Returns the status; empty until the session is ready. Starts the next measurement of the pace.
  std::optional<LoopStatus> takeStatus();

 private:
  using Clock = std::chrono::steady_clock;

  void main();
  void run();
  void tick(Session& session, const StylusSamples& samples, bool live);
  /// Delivers frames that are still in flight from the GPU and frames for new subscribers, without forces. Pacing
  /// restarts at the next tick.
  void rest(Session& session);
  void showSkin(Session& session);
  void deliver(const Session& session, Frame&& frame, const StylusSamples& samples, bool live);
  void resetInput(Session& session);
  CommandAnswer execute(const Command& command, Session& session);
  CommandAnswer change(const Command& command, Session& session);
  CommandAnswer setOverlays(const Command& command, Session& session);
  CommandAnswer step(const Command& command, Session& session);
  /// Returns the outputs that can be drawn: no images without OpenGL.
  FrameRequest drawable(const FrameRequest& outputs) const;
  /// Returns the samples of one tick of a step.
  StylusSamples samplesOf(const Command& command, uint32_t tick) const;

  const Scene scene_;
  std::unique_ptr<MadeSession> made_;
  const LoopPorts ports_;
  const Progress progress_;
  CommandQueue commands_;
  Pacer pacer_;
  bool paused_ = false;
  bool unseen_ = true;                       ///< whether the state changed and no tick has shown it
  bool input_reset_ = false;                 ///< whether input was discarded since the last tick
  std::optional<StylusSamples> stepped_to_;  ///< samples of the last step that had samples
  Clock::time_point tick_ended_{};
  std::atomic<bool> stop_{false}, ended_{false};
  std::exception_ptr error_;

  std::mutex status_mutex_;
  bool ready_ = false;
  LoopStatus status_;
  PaceMeter pace_;
  std::thread thread_;
};

}  // namespace viscera::nodes
