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

/// How the simulation does: a copy for the diagnostics.
struct LoopStatus {
  std::string gpu, backend, stepped_by;
  bool software_gpu = false;
  bool pictures = true;  ///< there is OpenGL to draw them with
  bool paused = false;
  double dt_s = 0, dt_safe_s = 0, dt_limit_s = 0;
  uint64_t tick = 0;
  Counters counters;
  layout::TickStats stats{};
  Health health;
  std::array<bool, layout::kMaxStyluses> held_back{}, inside{};
  std::array<Reaction, layout::kMaxStyluses> reactions;
  /// What each stylus does with no button pressed, and while the first or the second is.
  std::vector<std::array<ToolMode, 3>> modes;
  FactGroups facts;         ///< of what lives in the tissue
  PaceMeter::Reading pace;  ///< since the last LoopStatus was taken
};

/// What the loop asks of its surroundings, on its own thread. None of them may block.
struct LoopPorts {
  std::function<void(Session&)> place;  ///< obstacles that others carry, for a tick that begins now; may be null
  /// Cameras that others carry, also while the state stands still; @returns whether one has moved; may be null
  std::function<bool(Session&)> aim;
  std::function<StylusSamples()> samples;            ///< for that tick
  std::function<Wants()> wants;                      ///< of that tick
  std::function<void(const Session&, Frame&)> look;  ///< before a frame is delivered; may be null
  std::function<void(Session&)> ready;               ///< once, before the first tick
  std::function<void(const Session&)> leave;         ///< once, after the last one, while there is a session
  /// After every tick: what it took from the hands, and made of it. @param hands_anew  forgotten before it
  std::function<void(uint64_t tick, const StylusSamples&, const ToolMotions&, bool hands_anew)> stepped;
  /// What came back after a tick with these samples. @param live  the tissue follows the hands: forces may go out
  std::function<void(Frame&&, const StylusSamples&, bool live)> deliver;
  /// What is wanted of a state that stands still. @param changed  others than newcomers have not seen it either
  /// @param aimed  nor has anybody the pictures of some camera, which has moved
  std::function<Wants(bool changed, bool aimed)> stills;
  std::function<void()> rest;    ///< no forces, at once, until a tick is delivered that is live
  std::function<void()> forget;  ///< hands were not followed, or will not be: what devices said before is void
  std::function<void()> failed;  ///< an error has ended the thread
};

/// Owns the thread on which the OpenGL context and the session live, and paces it by the steady clock.
class SimulationLoop {
 public:
  /// Most ticks that one step command may ask for.
  static constexpr uint32_t kMaxStepTicks = 10000;

  /// @param made  a session of the scene that was made before, or as much of it; null: none
  SimulationLoop(const Scene& scene, std::unique_ptr<MadeSession> made, LoopPorts ports, Progress progress);
  ~SimulationLoop();
  SimulationLoop(const SimulationLoop&) = delete;
  SimulationLoop& operator=(const SimulationLoop&) = delete;

  /// The thread has ended: by stop(), or by an error that stop() will rethrow.
  bool ended() const { return ended_; }
  /// Ends the thread. @throws what ended it, if that was an error
  void stop();
  /// Of a thread that has ended: the session, so that its end may wait for a better time.
  std::unique_ptr<MadeSession> takeSession() { return std::move(made_); }

  CommandQueue& commands() { return commands_; }
  /// Nothing until the session is ready. The pace is measured again from here.
  std::optional<LoopStatus> takeStatus();

 private:
  using Clock = std::chrono::steady_clock;

  void main();
  void run();
  void tick(Session& session, const StylusSamples& samples, bool live);
  /// Hands over what is still on its way from the GPU and what newcomers want to see, without forces; time does not
  /// count until the next tick.
  void rest(Session& session);
  void showSkin(Session& session);
  void deliver(const Session& session, Frame&& frame, const StylusSamples& samples, bool live);
  void forgetHands(Session& session);
  CommandAnswer execute(const Command& command, Session& session);
  CommandAnswer change(const Command& command, Session& session);
  CommandAnswer setOverlays(const Command& command, Session& session);
  CommandAnswer step(const Command& command, Session& session);
  /// Without images where there is no OpenGL.
  Wants drawable(const Wants& wants) const;
  /// Of one tick of a step.
  StylusSamples samplesOf(const Command& command, uint32_t tick) const;

  const Scene scene_;
  std::unique_ptr<MadeSession> made_;
  const LoopPorts ports_;
  const Progress progress_;
  CommandQueue commands_;
  Pacer pacer_;
  bool paused_ = false;
  bool unseen_ = true;                       ///< the state changed, and no tick has shown it
  bool hands_anew_ = false;                  ///< hands were forgotten since the last tick
  std::optional<StylusSamples> stepped_to_;  ///< by a step whose caller said where the styluses are
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
