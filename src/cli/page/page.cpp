// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/page/page.h"

#include <algorithm>
#include <iostream>
#include <utility>

#include "math/number_text.h"
#include "math/one_line.h"
#include "tasks/task_kinds.h"
#include "tasks/task_measures.h"
#include "tasks/verdict.h"
#include "viscera/session/tissue_processes.h"

namespace viscera::cli {

namespace {

constexpr double kEventGap_s = 0.5;  // without an increase, after which an event has ended
constexpr double kTimeRounding_s = 1e-6;

std::string plural(double count, const std::string& one, const std::string& more) {
  return count == 1 ? one : numberText(count) + " " + more;
}

size_t clipsIn(const Frame& frame) {
  return static_cast<size_t>(std::count_if(frame.sutures.begin(), frame.sutures.end(),
                                           [](const VisibleTube& tube) { return tube.part == TubeKind::kClip; }));
}

size_t knotsIn(const Session& session) {
  size_t out = 0;
  for (const SutureState& suture : sutureStates(session)) out += suture.knots.size();
  return out;
}

}  // namespace

Page::Page(const PageOptions& options) : options_(options), writer_(options.file, options.rate_hz) {}

void Page::begin(Session& session, Album* album, const TaskWatch* tasks, double at_s) {
  tasks_ = tasks;
  writer_.follow(session);
  is_begun_ = true;
  at_s_ = due_s_ = at_s;
  springs_cut_ = clips_ = knots_ = -1;
  add(session, album);
}

void Page::stepped(Session& session, Album* album, double at_s) {
  at_s_ = at_s;
  if (at_s_ + kTimeRounding_s >= due_s_) add(session, album);
}

void Page::end(Session& session, Album* album) {
  if (is_begun_ && added_tick_ != session.tick()) add(session, album);
  is_begun_ = false;
  phase_ = TaskPhase::kWaiting;
  costs_.clear();
}

void Page::add(Session& session, Album* album) {
  const Frame now = frameNow(session, album);
  noteEvents(session, now);
  if (tasks_ && tasks_->task()) noteStatus(*tasks_);
  closeEvents(at_s_ - kEventGap_s);
  writer_.add(session, now, *now.surface, at_s_);
  added_tick_ = session.tick();
  while (due_s_ < at_s_ + kTimeRounding_s) due_s_ += 1 / options_.rate_hz;
}

void Page::noteEvents(const Session& session, const Frame& now) {
  noteIfMore(springs_cut_, now.has_stats ? now.stats.springs_cut : 0, "cut", "");
  noteIfMore(clips_, static_cast<double>(clipsIn(now)), "clip", "");
  noteIfMore(knots_, static_cast<double>(knotsIn(session)), "knot", "");
}

void Page::noteStatus(const TaskWatch& tasks) {
  const TaskConfig& task = *tasks.task();
  const TaskStatus& status = tasks.status();
  const std::string name = task.title.empty() ? task.name : task.title;
  writer_.setStatus({name, status.step, status.score});
  if (costs_.empty()) writer_.setLines(kindOf(task.kind).shapes(task).lines_m);
  for (const TaskMeasure& measure : kTaskMeasures) {
    auto known = costs_.emplace(measure.name, 0).first;
    noteIfMore(known->second, costOf(task, status.tally, measure), "mistake", phraseOf(task, measure));
  }
  if (status.state != phase_ && status.state != TaskPhase::kWaiting) {
    const std::string what = status.state == TaskPhase::kRunning ? "begins" : nameOf(status.state);
    writer_.addMark("task", name + ": " + what, at_s_, at_s_);
  }
  phase_ = status.state;
}

/// Notes an event if a value has increased. @param before  the value at the last moment, < 0: unknown; in, out
void Page::noteIfMore(double& before, double now, const std::string& kind, const std::string& text) {
  if (before >= 0 && now > before) note(kind, text, now - before);
  before = now;
}

void Page::note(const std::string& kind, const std::string& text, double amount) {
  const auto same = std::find_if(open_.begin(), open_.end(),
                                 [&](const Event& event) { return event.kind == kind && event.text == text; });
  if (same == open_.end()) {
    open_.push_back({kind, text, at_s_, at_s_, amount});
    return;
  }
  same->to_s = at_s_;
  same->amount += amount;
}

std::string Page::textOf(const Event& event) const {
  if (event.kind == "cut") return "cut through " + plural(event.amount, "one spring", "springs");
  if (event.kind == "clip") return plural(event.amount, "clip set", "clips set");
  if (event.kind == "knot") return plural(event.amount, "knot tied", "knots tied");
  return event.text + ": costs " + numberText(event.amount, 3) + " points";
}

/// Writes events that have not gone on since a time.
void Page::closeEvents(double until_s) {
  for (const Event& event : open_)
    if (event.to_s < until_s) writer_.addMark(event.kind, textOf(event), event.from_s, event.to_s);
  open_.erase(std::remove_if(open_.begin(), open_.end(), [&](const Event& event) { return event.to_s < until_s; }),
              open_.end());
}

void Page::finish() {
  closeEvents(at_s_ + 1);
  writer_.finish();
  std::cout << "page: " << oneLine(options_.file) << ", " << writer_.frames()
            << (writer_.frames() == 1 ? " frame, " : " frames, ") << numberText(options_.rate_hz) << " per second, "
            << fixedText(static_cast<double>(writer_.bytes()) / 1e6, 2) << " MB\n";
}

}  // namespace viscera::cli
