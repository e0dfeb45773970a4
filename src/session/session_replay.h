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

/// A recording made again: the sessions that were recorded, one after another, do what was done to them then. Time is
/// that of all steps of the recording, whatever resets came between.
class SessionReplay {
 public:
  /// A session of the recording.
  struct Part {
    uint64_t place = 0;  ///< of its chunk in the file
    RecordedScene scene;
    double from_s = 0, to_s = 0;
  };
  /// States that differ though they should not.
  struct Difference {
    size_t part = 0;
    uint64_t tick = 0, last_same_tick = 0;  ///< whose hashes were compared
    std::optional<uint64_t> measured_tick;  ///< the first in between whose measurements differ
    uint64_t recorded_hash = 0, replayed_hash = 0;
  };
  struct Outcome {
    double at_s = 0;
    uint64_t steps = 0, compared = 0;  ///< steps made; hashes compared
    bool ended = false;                ///< as the recording did, whose last hash was compared
    std::optional<Difference> difference;
  };
  struct Ports {
    /// A session of a scene, which lives until the next one is asked for.
    std::function<Session&(const Scene&, size_t part)> make;
    /// It comes to another state at once: what is under way belongs to the one before.
    std::function<void(Session&)> leaps;
    std::function<Wants(const Session&)> wants;                   ///< of the step to come
    std::function<void(Session&, Frame&&, double at_s)> stepped;  ///< of those that are to be looked at
  };

  /// Looks through all of it. @throws Error  it cannot be read, is no recording, or of another version
  explicit SessionReplay(const std::string& path);
  const std::vector<Part>& parts() const { return parts_; }
  double duration_s() const { return duration_s_; }
  /// Why it ends where it does, where it was not recorded to its end; empty: it was.
  const std::string& damage() const { return damage_; }

  /// @param from_s  steps after this are looked at; it begins at the last state before
  /// @param until_s  steps after this are not made   @param overrides  of keys that change no state
  /// @throws Error  a state is of another scene or backend; SceneError; what `ports` throw
  Outcome run(double from_s, double until_s, const Overrides& overrides, const Ports& ports);

 private:
  struct Place {
    uint64_t place;
    size_t part;
    double at_s;
  };
  class Run;
  void index();

  RecordFileReader file_;
  std::vector<Part> parts_;
  std::vector<Place> states_;
  double duration_s_ = 0;
  std::string damage_;
};

}  // namespace viscera
