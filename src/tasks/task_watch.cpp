// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tasks/task_watch.h"

#include <algorithm>
#include <cmath>

#include "math/float_bits.h"
#include "math/number_text.h"
#include "tasks/task_kinds.h"
#include "viscera/session/tissue_processes.h"

namespace viscera {

const char* nameOf(TaskPhase state) {
  constexpr const char* kNames[] = {"waiting", "running", "passed", "failed"};
  return kNames[static_cast<size_t>(state)];
}

double costOf(const TaskConfig& task, const TaskTally& tally, const TaskMeasure& measure) {
  double out = 0;
  for (const TaskRule& rule : task.measures)
    if (rule.measure == measure.name) out += rule.cost_s * tally.*measure.value;
  return out;
}

TaskWatch::TaskWatch(Session& session, std::function<void(TaskResult&&)> ended)
    : session_(session), ended_(std::move(ended)) {
  session.addLog(*this);
}

TaskWatch::~TaskWatch() {
  session_.removeLog(*this);
  if (task_) session_.showMarks({});
}

/// Shows the marks in their present states.
void TaskWatch::showMarks() {
  std::vector<MarkState> states = judge_->markStates();
  if (states == mark_states_) return;
  session_.showMarks(styledMarks(judge_->marks(), states));
  mark_states_ = std::move(states);
}

void TaskWatch::begin(std::unique_ptr<TaskJudge> judge) {
  status_ = {};
  status_.step = "starts with the first tracked stylus";
  judge_ = std::move(judge);
  cut_watch_.emplace(session_.model());
  if (needsCuts()) {
    session_.solver().readCuts(cuts_);
    cut_watch_->fresh(cuts_);  // earlier cuts do not belong to this task
  }
  whole_fibres_ = 0;
  mark_states_.clear();
  showMarks();
  base_tick_ = session_.tick();
  base_blood_ml_ = seenBlood(session_).bled_ml;
  base_bile_ml_ = seenBile(session_).bled_ml;
  stepped_.clear();
  measured_.clear();
  tools_.emplace(session_);
  cuts_m_.clear();
}

void TaskWatch::taskRecorded(Session&, const std::string& name, const std::string& yaml) {
  if (yaml.empty()) return giveUp("the task was given up");
  TaskConfig task = parseTask(yaml, name);
  // If these throw, the present task continues.
  placeTask(task, session_.model());
  std::unique_ptr<TaskJudge> judge = kindOf(task.kind).judge(task, session_);
  spared_.emplace(sparedParts(task));
  task_ = std::move(task);
  begin(std::move(judge));
}

SparedParts TaskWatch::sparedParts(const TaskConfig& task) const {
  try {
    return {session_.model(), task.spared_parts};
  } catch (const TaskError& error) {
    throw TaskError(task.name + ": " + error.what());
  }
}

void TaskWatch::wasReset() {
  if (task_) begin(kindOf(task_->kind).judge(*task_, session_));
}

void TaskWatch::restored(Session&) {
  wasReset();
}

void TaskWatch::stepped(Session& session, const StylusSamples& samples) {
  if (!isOpen()) return;
  tools_->addRow(session, samples);
  TaskTick tick;
  tick.motions = session.motions();
  tick.tick_s = session.tick_s();
  if (judge_->usesFibres()) tick.fibres = seenFibres(session);
  const bool parted = partsFibres(tick.fibres);
  const bool cut = needsCuts() && session.solver().readCuts(cuts_);
  if (cut || (parted && needsCuts())) {  // any cause: blades, heat, sutures, tears
    const std::vector<FreshCut> cuts = cut_watch_->fresh(cuts_);
    for (const FreshCut& fresh : cuts) tick.cuts_m.push_back(fresh.at_m);
    tick.spared_cuts = spared_->count(cuts);
    tick.apart = judge_->piecesApart(cuts_, tick.fibres);
  }
  if (judge_->usesSutures()) {
    tick.sutures = sutureStates(session);
    if (judge_->asksForGap(tick.sutures)) tick.gap_m = judge_->gapOf(session.solver().readState());
  }
  if (judge_->usesClips()) tick.clips = seenClips(session);
  tick.blood_ml = seenBlood(session).bled_ml;
  tick.bile_ml = seenBile(session).bled_ml;
  stepped_.push_back(std::move(tick));
  judgeNoted();
}

/// Returns whether the number of whole fibres has changed.
bool TaskWatch::partsFibres(const std::vector<FibreState>& fibres) {
  const auto whole = static_cast<size_t>(
      std::count_if(fibres.begin(), fibres.end(), [](const FibreState& fibre) { return fibre.whole; }));
  const bool changed = whole != whole_fibres_;
  whole_fibres_ = whole;
  return changed;
}

void TaskWatch::measured(const Session& session, uint64_t tick, const layout::TickStats& stats) {
  if (!isOpen() || tick <= base_tick_) return;
  tools_->addForces(session, stats);
  measured_.push_back(stats);
  judgeNoted();
}

void TaskWatch::judgeNoted() {
  while (isOpen() && !stepped_.empty() && !measured_.empty()) {
    TaskTick tick = std::move(stepped_.front());
    tick.stats = measured_.front();
    stepped_.pop_front();
    measured_.pop_front();
    judge(tick);
  }
}

void TaskWatch::judge(const TaskTick& tick) {
  const auto present = [](const StylusMotion& motion) { return motion.present; };
  if (status_.state == TaskPhase::kWaiting) {
    if (std::none_of(tick.motions.begin(), tick.motions.end(), present)) {
      tools_->rows.erase(tools_->rows.begin());  // ticks without a tracked stylus
      tools_->forces.erase(tools_->forces.begin());
      return;
    }
    status_.state = TaskPhase::kRunning;
  }
  status_.time_s += tick.tick_s;
  springs_cut_ = tick.stats.springs_cut;
  count(tick);
  cuts_m_.insert(cuts_m_.end(), tick.cuts_m.begin(), tick.cuts_m.end());
  judge_->judge(tick, status_.tally);
  showMarks();
  status_.progress = judge_->progress();
  status_.step = judge_->step();
  status_.penalties_s = 0;
  for (const TaskMeasure& measure : kTaskMeasures) status_.penalties_s += costOf(*task_, status_.tally, measure);
  status_.score = std::max(0.0, task_->time_limit_s - status_.time_s - status_.penalties_s);
  decide();
}

/// Counts what all kinds count.
void TaskWatch::count(const TaskTick& tick) {
  TaskTally& tally = status_.tally;
  tally.blood_ml = tick.blood_ml - base_blood_ml_;
  tally.bile_ml = tick.bile_ml - base_bile_ml_;
  tally.spared_cuts += static_cast<double>(tick.spared_cuts);
  double largest_n = 0;
  for (size_t s = 0; s < tick.motions.size(); ++s) {
    const StylusMotion& motion = tick.motions[s];
    if (!motion.present) continue;
    tally.path_m += (motion.to.position_m - motion.from.position_m).norm();
    const layout::vec4& impulse = tick.stats.impulse[s];
    const double force_n = Vector3d(impulse.x, impulse.y, impulse.z).norm() / tick.tick_s;
    if (std::isfinite(force_n)) largest_n = std::max(largest_n, force_n);
  }
  tally.peak_force_n = std::max(tally.peak_force_n, largest_n);
  tally.force_s += largest_n > task_->limits.force_n ? tick.tick_s : 0;
  const double strain = floatFromBits(tick.stats.max_stretch_bits);
  tally.peak_strain = std::max(tally.peak_strain, strain);
  tally.strain_s += strain > task_->limits.strain ? tick.tick_s : 0;
}

/// Returns why a measure of a rule fails the task, or empty.
std::string TaskWatch::exceeded(const TaskRule& rule) const {
  for (const TaskMeasure& measure : kTaskMeasures) {
    if (rule.measure != measure.name || status_.tally.*measure.value <= rule.most) continue;
    TextOut why;
    why << measure.name << " is " << status_.tally.*measure.value << "; to pass it must be at most " << rule.most;
    return why.str();
  }
  return "";
}

/// Ends the task if it is decided. A cut in tissue to be spared cannot be made good, so it ends at once.
void TaskWatch::decide() {
  const bool reached = judge_->reached();
  for (const TaskRule& rule : task_->measures) {
    if (!reached && rule.measure != kSparedCuts) continue;
    const std::string why = exceeded(rule);
    if (!why.empty()) return end(TaskPhase::kFailed, why);
  }
  if (!reached) {
    if (status_.time_s >= task_->time_limit_s) end(TaskPhase::kFailed, "the time limit was reached before the goal");
    return;
  }
  if (status_.score >= task_->pass_score) return end(TaskPhase::kPassed, "done");
  TextOut why;
  why << "the score is " << status_.score << "; to pass it must be at least " << task_->pass_score;
  end(TaskPhase::kFailed, why.str());
}

void TaskWatch::giveUp(const std::string& why) {
  if (isOpen()) end(TaskPhase::kFailed, why);
}

void TaskWatch::end(TaskPhase state, const std::string& why) {
  status_.state = state;
  status_.step = why;
  status_.reached = judge_->reached();
  if (!status_.reached) status_.score = 0;
  tools_->rows.resize(std::min(tools_->rows.size(), tools_->forces.size()));  // later ticks do not belong to it
  if (ended_) ended_({*task_, status_, *tools_, cuts_m_, springs_cut_});
}

}  // namespace viscera
