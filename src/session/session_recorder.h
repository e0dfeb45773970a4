// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "session/record_file.h"
#include "session/session_event.h"
#include "viscera/session/session_log.h"

namespace viscera {

/// Writes all that happens to sessions, one after another, into a file from which SessionReplay makes them again.
class SessionRecorder : public SessionLog {
 public:
  /// @param most_bytes  of the file: the recording ends, with a fault, before it is larger
  /// @throws Error  the file is there already, or cannot be made
  explicit SessionRecorder(const std::string& path, uint64_t most_bytes = UINT64_MAX)
      : path_(path), file_(path, most_bytes) {}

  /// From now on, until leave(). On the session's thread, as all below.
  void follow(Session& session);
  /// It is recorded to here, or nothing was. To be called before the session ends.
  void leave();
  /// The session has ended without leave(): only it knows how.
  void forget() { session_ = nullptr; }
  /// All of it is on the disk, or fault() says why not. Nothing is recorded after this.
  void finish() { file_.finish(); }
  const std::string& path() const { return path_; }
  std::string fault() const { return file_.fault(); }  ///< why nothing is written any more; empty: it is

  void stepped(Session& session, const StylusSamples& samples) override;
  void measured(const Session& session, uint64_t tick, const layout::TickStats& stats) override;
  void wasReset() override;
  void handsForgotten() override;
  void restored(Session& session) override;
  void toolModeSet(size_t stylus, ToolSwitch when, ToolMode mode) override;
  void forceLimitsSet(size_t stylus, const ForceLimits& limits) override;
  void obstacleFrameSet(size_t obstacle, const Pose& pose) override;
  void cameraFrameSet(size_t camera, const Pose& pose) override;
  void threadTied(size_t piece, const ThreadTie& tie) override;
  void taskNoted(Session& session, const std::string& name, const std::string& yaml) override;
  void overlaysSet(size_t camera, const Overlays& overlays) override;

 private:
  void put(SessionEvent& event);
  void putState(Session& session, bool leaps);

  const std::string path_;
  RecordFileWriter file_;
  Session* session_ = nullptr;  ///< that is followed
  uint64_t steps_since_state_ = 0;
};

}  // namespace viscera
