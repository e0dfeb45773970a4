// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "session/record_file.h"
#include "session/session_recording.h"
#include "viscera/session/session.h"

namespace viscera {

struct SessionEvent;

/// Replay of a recording: applies the recorded events to new sessions, one after another. Time counts all steps of the
/// recording, across resets.
class SessionReplay {
 public:
  /// Session of the recording.
  struct Part {
    uint64_t position = 0;  ///< position of its chunk in the file
    RecordedScene scene;
    double from_s = 0, to_s = 0;
  };
  /// Two states that differ although they should be equal.
  struct Difference {
    size_t part = 0;
    uint64_t tick = 0, last_same_tick = 0;  ///< ticks with compared hashes
    std::optional<uint64_t> measured_tick;  ///< first tick in between with measurements that differ
    uint64_t recorded_hash = 0, replayed_hash = 0;
  };
  struct Outcome {
    double at_s = 0;
    uint64_t steps = 0, compared = 0;  ///< steps made; hashes compared
    bool ended = false;                ///< ended like the recording, with a comparison of its last hash
    std::optional<Difference> difference;
  };
  struct Ports {
    /// Makes a session of a scene, which lives until the next call.
    std::function<Session&(const Scene&, size_t part)> make;
    /// Handles a jump of the session to another state: what is in flight belongs to the state before.
    std::function<void(Session&)> leaps;
    std::function<FrameRequest(const Session&)> outputs;          ///< outputs of the coming step
    std::function<void(Session&, Frame&&, double at_s)> stepped;  ///< called for steps that are to be shown
  };

  /// Scans the whole recording. @throws Error  it cannot be read, is no recording, or is of another version
  explicit SessionReplay(const std::string& path);
  const std::vector<Part>& parts() const { return parts_; }
  double duration_s() const { return duration_s_; }
  /// Returns why it ends early, if it was not recorded to its end; empty: it was.
  const std::string& damage() const { return damage_; }

  /// Replays the recording. @param from_s  steps after this are shown; it begins at the last state before it
  /// @param until_s  steps after this are not made   @param overrides  of keys that change no state
  /// @throws Error  a state is of another scene or backend; SceneError; what `ports` throw
  Outcome run(double from_s, double until_s, const Overrides& overrides, const Ports& ports);

 private:
  struct Position {
    uint64_t position;
    size_t part;
    double at_s;
  };
  class Run;
  void index();

  RecordFileReader file_;
  std::vector<Part> parts_;
  std::vector<Position> states_;
  double duration_s_ = 0;
  std::string damage_;
};

}  // namespace viscera
