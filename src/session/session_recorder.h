// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "session/record_file.h"
#include "session/session_event.h"
#include "viscera/session/session_log.h"

namespace viscera {

/// Log that writes all changes of successive sessions to a file from which SessionReplay reproduces them.
class SessionRecorder : public SessionLog {
 public:
  /// @param most_bytes  of the file: before it is larger, the recording ends with a fault
  /// @throws Error  the file exists already, or cannot be created
  explicit SessionRecorder(const std::string& path, uint64_t most_bytes = UINT64_MAX)
      : path_(path), file_(path, most_bytes) {}

  /// Records a session from now on, until leave(). Call this and all below on the session's thread.
  void follow(Session& session);
  /// Ends the recording of the session, if there is one. Call it before the session ends.
  void leave();
  /// Drops a session that has ended without leave(); its final state is unknown.
  void clear() { session_ = nullptr; }
  /// Waits until all of it is on disk, or fault() has the reason. Nothing is recorded after this.
  void finish() { file_.finish(); }
  const std::string& path() const { return path_; }
  std::string fault() const { return file_.fault(); }  ///< reason why writing stopped; empty: it continues

  void stepped(Session& session, const StylusSamples& samples) override;
  void measured(const Session& session, uint64_t tick, const layout::TickStats& stats) override;
  void wasReset() override;
  void inputCleared() override;
  void restored(Session& session) override;
  void toolModeSet(size_t stylus, ToolSwitch when, ToolMode mode) override;
  void forceLimitsSet(size_t stylus, const ForceLimits& limits) override;
  void obstacleFrameSet(size_t obstacle, const Pose& pose) override;
  void cameraFrameSet(size_t camera, const Pose& pose) override;
  void sutureTied(size_t piece, const SutureTie& tie) override;
  void taskRecorded(Session& session, const std::string& name, const std::string& yaml) override;
  void overlaysSet(size_t camera, const Overlays& overlays) override;

 private:
  void put(SessionEvent& event);
  void putState(Session& session, bool leaps);

  const std::string path_;
  RecordFileWriter file_;
  Session* session_ = nullptr;  ///< the recorded session
  uint64_t steps_since_state_ = 0;
};

}  // namespace viscera
