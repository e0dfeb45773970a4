// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <mutex>
#include <string>

#include "session/session_recorder.h"

namespace viscera {

/// Switch that starts and stops recordings of successive sessions. Call all functions except fault() and file() on the
/// session's thread.
class RecordingSwitch {
 public:
  /// @param place  a file to create, or a folder, in which it is named after the time; empty: no recording yet
  explicit RecordingSwitch(const std::string& target) : target_(target) {}

  /// Begins a session: the recording continues with it. @throws Error  the file cannot be created
  void follow(Session& session);
  /// Ends the session.
  void leave();
  /// Starts a recording. @param most_bytes  of the file; reaching it ends the recording
  /// @returns the file   @throws Error  it exists already or cannot be created; a recording is running
  std::string start(Session& session, const std::string& path, uint64_t most_bytes = UINT64_MAX);
  /// Stops the recording. @returns the file   @throws Error  nothing is recorded; or the reason why not all of it was
  std::string stop();
  std::string fault() const;  ///< reason why recording stopped; empty: no fault
  std::string file() const;   ///< file of the recording; empty: none. Callable from any thread, like fault()

 private:
  std::string target_;        ///< of a recording that has not begun
  mutable std::mutex mutex_;  ///< protects the pointer
  std::unique_ptr<SessionRecorder> recorder_;
};

}  // namespace viscera
