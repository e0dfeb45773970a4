// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "session/recording_switch.h"

#include <ctime>
#include <filesystem>
#include <utility>

#include "viscera/math/error.h"

namespace viscera {

namespace {

/// Returns the path of a recording; in a folder, a name made of the present second.
std::string recordingPath(const std::string& target) {
  std::error_code error;
  if (target.back() != '/' && !std::filesystem::is_directory(target, error)) return target;
  std::filesystem::create_directories(target, error);
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char name[64];
  std::strftime(name, sizeof name, "session_%Y%m%dT%H%M%SZ.viscera", &utc);
  return (std::filesystem::path(target) / name).string();
}

}  // namespace

void RecordingSwitch::follow(Session& session) {
  if (recorder_) {
    recorder_->clear();  // the previous session, if it did not report its end
    recorder_->follow(session);
  } else if (!target_.empty()) {
    start(session, recordingPath(std::exchange(target_, "")));
  }
}

void RecordingSwitch::leave() {
  if (recorder_) recorder_->leave();
}

std::string RecordingSwitch::start(Session& session, const std::string& path, uint64_t most_bytes) {
  if (recorder_ && recorder_->fault().empty()) throw Error("recording into " + recorder_->path() + " already");
  auto made = std::make_unique<SessionRecorder>(path, most_bytes);
  made->follow(session);
  if (recorder_) recorder_->leave();
  const std::lock_guard<std::mutex> lock(mutex_);
  recorder_ = std::move(made);
  return path;
}

std::string RecordingSwitch::stop() {
  if (!recorder_) throw Error("nothing is being recorded");
  recorder_->leave();
  recorder_->finish();
  const std::string path = recorder_->path(), fault = recorder_->fault();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    recorder_.reset();
  }
  if (!fault.empty()) throw Error(fault);
  return path;
}

std::string RecordingSwitch::fault() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return recorder_ ? recorder_->fault() : "";
}

std::string RecordingSwitch::file() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return recorder_ && recorder_->fault().empty() ? recorder_->path() : "";
}

}  // namespace viscera
