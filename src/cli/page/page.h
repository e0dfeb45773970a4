// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <string>

#include "cli/album.h"
#include "cli/page/page_options.h"
#include "export/page/page_writer.h"
#include "tasks/task_watch.h"

namespace viscera::cli {

/// Page of a session (docs/replay.md): a surface mesh with tools at the rate of the options, and marks of events. The
/// file appears with finish(), and not at all after an error.
class Page {
 public:
  /// Begins the file. @throws Error  it cannot be written
  explicit Page(const PageOptions& options);

  /// Begins a session, or its continuation in another state, and adds the moment before its next step.
  /// @param album  receives images that are ready; null: none   @param tasks  of the session, until end(); null: none
  /// @param at_s  time of that moment on the page
  void begin(Session& session, Album* album, const TaskWatch* tasks, double at_s);
  /// Adds the moment after a step if it is due.
  void stepped(Session& session, Album* album, double at_s);
  /// Adds the last moment of a session.
  void end(Session& session, Album* album);
  void addMark(const std::string& text, double at_s) { writer_.addMark("mark", text, at_s, at_s); }
  /// Ends the page and prints what was written. @throws Error
  void finish();

 private:
  /// An event that may last for several frames.
  struct Event {
    std::string kind, text;
    double from_s, to_s, amount;
  };
  void add(Session& session, Album* album);
  void noteEvents(const Session& session, const Frame& now);
  void noteStatus(const TaskWatch& tasks);
  void note(const std::string& kind, const std::string& text, double amount);
  void noteIfMore(double& before, double now, const std::string& kind, const std::string& text);
  std::string textOf(const Event& event) const;
  void closeEvents(double until_s);

  const PageOptions options_;
  PageWriter writer_;
  const TaskWatch* tasks_ = nullptr;
  double at_s_ = 0, due_s_ = 0;
  uint64_t added_tick_ = 0;
  bool is_begun_ = false;
  // Values at the last moment, of which an increase is an event.
  double springs_cut_ = 0, clips_ = 0, knots_ = 0;
  TaskPhase phase_ = TaskPhase::kWaiting;
  std::map<std::string, double> costs_;
  std::vector<Event> open_;  ///< events that may go on
};

}  // namespace viscera::cli
