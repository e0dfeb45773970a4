// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <mutex>
#include <string>

#include "session/session_recorder.h"

namespace viscera {

/// Begins and ends recordings of sessions that follow one another. All but fault() and file() on the thread of the
/// session.
class RecordingSwitch {
 public:
  /// @param place  a file that is to be made, or a folder, in which it is named after the time; empty: none yet
  explicit RecordingSwitch(const std::string& place) : place_(place) {}

  /// A session begins: what is recorded goes on with it. @throws Error  the file cannot be made
  void follow(Session& session);
  /// It ends.
  void leave();
  /// @param most_bytes  of the file, with which the recording ends
  /// @returns the file   @throws Error  it is there already or cannot be made; a recording is under way
  std::string start(Session& session, const std::string& path, uint64_t most_bytes = UINT64_MAX);
  /// @returns the file   @throws Error  nothing is recorded; or why not all of it was
  std::string stop();
  std::string fault() const;  ///< why nothing is recorded any more; empty: nothing went wrong
  std::string file() const;   ///< into which is recorded; empty: none. From any thread, as fault()

 private:
  std::string place_;         ///< of a recording that is still to begin
  mutable std::mutex mutex_;  ///< of the pointer
  std::unique_ptr<SessionRecorder> recorder_;
};

}  // namespace viscera
