// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/simulator/task_switch.h"

#include <ros/console.h>
#include <viscera/StartTask.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <utility>

#include "math/float_bits.h"
#include "math/one_line.h"
#include "model/scene/file_bounds.h"
#include "tasks/task_kinds.h"
#include "tasks/task_notes.h"
#include "tasks/task_report.h"
#include "tasks/verdict.h"
#include "viscera/math/state_hash.h"

namespace viscera::nodes {
namespace {

constexpr double kTaskPeriod_s = 0.2, kMetricsPeriod_s = 0.5;
constexpr const char *kAtStart = "at the start", *kAtEnd = "at the end";
using TaskClock = std::chrono::steady_clock;

bool isPast(TaskClock::time_point since, double period_s) {
  return std::chrono::duration<double>(TaskClock::now() - since).count() >= period_s;
}

std::string reportFolder(const std::string& folder, const std::string& task) {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char stamp[32];
  std::strftime(stamp, sizeof stamp, "_%Y%m%dT%H%M%SZ", &utc);
  return (std::filesystem::absolute(folder) / ("report_" + task + stamp)).string();
}

void addTool(Metrics& message, const std::string& stylus, const ToolMetrics& tool) {
  message.styluses.push_back(stylus);
  message.time_s.push_back(tool.time_s);
  message.path_m.push_back(tool.path_m);
  message.economy.push_back(tool.economy);
  message.sparc.push_back(tool.sparc);
  message.log_dimensionless_jerk.push_back(tool.log_jerk);
  message.peak_force_n.push_back(tool.peak_force_n);
  message.mean_force_n.push_back(tool.mean_force_n);
  message.force_time_ns.push_back(tool.force_time_ns);
  message.force_volume_n3.push_back(tool.force_volume_n3);
}

uint8_t messageState(TaskPhase phase) {
  constexpr uint8_t kStates[] = {TaskState::WAITING, TaskState::RUNNING, TaskState::PASSED, TaskState::FAILED};
  return kStates[static_cast<size_t>(phase)];
}

void fill(TaskState& message, const TaskConfig& task, const TaskStatus& status) {
  message.task = task.name;
  message.kind = kindOf(task.kind).name;
  message.title = task.title;
  message.instructions = task.instructions;
  message.state = messageState(status.state);
  message.step = status.step;
  message.time_s = status.time_s;
  message.time_limit_s = task.time_limit_s;
  message.proficiency_s = task.proficiency_s;
  message.progress = status.progress;
  message.penalties_s = status.penalties_s;
  message.score = status.score;
  message.pass_score = task.pass_score;
  message.measures.clear();
  message.values.clear();
  message.measure_penalties_s.clear();
  for (const TaskMeasure& measure : kTaskMeasures) {
    message.measures.emplace_back(measure.name);
    message.values.push_back(status.tally.*measure.value);
    message.measure_penalties_s.push_back(costOf(task, status.tally, measure));
  }
}

}  // namespace

TaskSwitch::TaskSwitch(ros::NodeHandle node, const Scene& scene, const SceneChoice& choice,
                       const std::string& package_folder, const SavedFolder& saved_folder, const std::string& trainee)
    : choice_(choice),
      package_folder_(package_folder),
      saved_folder_(saved_folder),
      trainee_(trainee),
      tick_s_(1 / scene.solver.tick_hz),
      state_publisher_(node.advertise<TaskState>("task_state", 1, true)),
      metrics_publisher_(node.advertise<Metrics>("metrics", 1)) {
  if (!choice.task.empty()) last_ = loadTask(choice.task);
  for (const StylusConfig& stylus : scene.styluses) styluses_.push_back(stylus.name);
  state_.header.frame_id = metrics_.header.frame_id = scene.environment.tissue_frame;
  tallies_.assign(styluses_.size(), ToolTally(1 / tick_s_));
  timer_ = node.createWallTimer(ros::WallDuration(kTaskPeriod_s), [this](const ros::WallTimerEvent&) { onTimer(); });
}

TaskSwitch::~TaskSwitch() {
  timer_.stop();
  writeReport();
  if (reporting_.valid()) reporting_.wait();
}

TaskConfig TaskSwitch::find(const std::string& name) const {
  if (name.empty()) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!last_) throw Error("task: none was chosen before; name one in config/tasks, or give an absolute path");
    return *last_;
  }
  const std::string file = taskFile("task", name, package_folder_);
  TaskConfig task = loadTask(file);
  if (sceneFile(sceneOfTask(task, file), package_folder_) != sceneFile(choice_.scene, package_folder_))
    throw Error("task: " + task.name + " needs the scene " + sceneOfTask(task, file) + ", but " + choice_.scene +
                " runs; " + StartTaskResponse::LOAD_SCENE_FIRST);
  return task;
}

void TaskSwitch::follow(Session& session, bool pictures) {
  session_ = &session;
  pictures_.setCanDraw(pictures && !session.scene().cameras.empty());
  session.addLog(*this);
  watch_ = std::make_unique<TaskWatch>(session, [this](TaskResult&& result) { report(std::move(result)); });
  if (!last_) return;
  session.recordTask(last_->name, last_->yaml);
  pictures_.ask(kAtStart, "start", session.tick());
}

void TaskSwitch::leave() {
  watch_.reset();
  writeReport();
  if (session_) std::exchange(session_, nullptr)->removeLog(*this);
}

std::string TaskSwitch::start(Session& session, const TaskConfig& task, const std::string& trainee) {
  writeReport();  // of the task before, which may wait for an image
  session.reset();
  pictures_.clear();
  for (const std::string& note : taskNotes(task)) ROS_WARN("task %s: %s", task.name.c_str(), note.c_str());
  session.recordTask(task.name, task.yaml);
  pictures_.ask(kAtStart, "start", session.tick());
  const std::lock_guard<std::mutex> lock(mutex_);
  last_ = task;
  if (!trainee.empty()) trainee_ = trainee;
  has_started_ = true;
  state_.report.clear();
  return task.title;
}

std::string TaskSwitch::end(Session& session) {
  if (!watch_->task() || watch_->status().state > TaskPhase::kRunning) throw Error("no task is running");
  session.recordTask("", "");
  return watch_->status().step;
}

void TaskSwitch::clear() {
  std::fill(tallies_.begin(), tallies_.end(), ToolTally(1 / tick_s_));
  peak_strain_ = 0;
  noticed_ = {};
}

void TaskSwitch::stepped(Session&, const StylusSamples& samples) {
  for (size_t s = 0; s < tallies_.size(); ++s) tallies_[s].addPosition(samples[s].valid, samples[s].pose.position_m);
}

void TaskSwitch::measured(const Session&, uint64_t tick, const layout::TickStats& stats) {
  for (size_t s = 0; s < tallies_.size(); ++s) {
    const layout::vec4& impulse = stats.impulse[s];
    tallies_[s].addForce(-Vector3d(impulse.x, impulse.y, impulse.z) / tick_s_);
  }
  const double strain = floatFromBits(stats.max_stretch_bits);
  peak_strain_ = std::max(peak_strain_, strain);
  measured_tick_ = tick;
  springs_cut_ = stats.springs_cut;
}

FrameRequest TaskSwitch::with(FrameRequest outputs) const {
  pictures_.addTo(outputs);
  return outputs;
}

void TaskSwitch::notice(const Frame& frame) {
  if (!watch_) return;
  pictures_.take(frame.images, frame.tick);
  if (ended_ && !pictures_.waits()) writeReport();
  const bool turned =
      std::exchange(has_started_, false) || (watch_->task() && state_.state != messageState(watch_->status().state));
  if (!turned && !isPast(noticed_, kTaskPeriod_s)) return;
  noticed_ = TaskClock::now();
  const std::lock_guard<std::mutex> lock(mutex_);
  if (watch_->task()) {
    fill(state_, *watch_->task(), watch_->status());
    changed_ = changed_ || turned || watch_->status().state == TaskPhase::kRunning;
  }
  if (metrics_publisher_.getNumSubscribers() == 0) return;
  Metrics message;
  message.header = metrics_.header;
  message.tick = measured_tick_;
  message.springs_cut = springs_cut_;
  message.peak_strain = peak_strain_;
  for (size_t s = 0; s < styluses_.size(); ++s) addTool(message, styluses_[s], tallies_[s].metrics());
  metrics_ = std::move(message);
}

Metrics TaskSwitch::metricsOf(const TaskResult& result) const {
  Metrics out;
  out.header = metrics_.header;
  out.complete = true;
  out.springs_cut = result.springs_cut;
  out.peak_strain = result.status.tally.peak_strain;
  if (!result.tools.rows.empty()) out.tick = result.tools.rows.back().tick;
  for (size_t s = 0; s < styluses_.size(); ++s) addTool(out, styluses_[s], viscera::metricsOf(result.tools.track(s)));
  return out;
}

void TaskSwitch::report(TaskResult&& result) {
  writeReport();
  Ended ended{std::move(result), {}, attemptAt(std::time(nullptr), trainee_)};
  ended.folder = reportFolder(saved_folder_.path(), ended.result.task.name);
  ended.attempt.state_hash = StateHash::text(session_->stateHash());
  ended_ = std::move(ended);
  pictures_.ask(kAtEnd, "end", session_->tick());
}

/// Writes the report of the task that has ended, if any, on a thread of its own, since smoothness, plots and files take
/// time.
void TaskSwitch::writeReport() {
  if (!ended_) return;
  if (reporting_.valid()) reporting_.wait();
  reporting_ = std::async(std::launch::async, [this, folder = ended_->folder, attempt = ended_->attempt,
                                               done = std::move(ended_->result), pictures = pictures_.release()] {
    Metrics metrics = metricsOf(done);
    metrics.header.stamp = ros::Time::now();
    metrics_publisher_.publish(metrics);
    ROS_INFO("task %s: %s %s", done.task.name.c_str(), oneLine(verdictText(done.task, done.status)).c_str(),
             mistakesText(done.task, done.status).c_str());
    try {
      saved_folder_.room();
      viscera::writeReport(folder, done, attempt, TaskPictures::write(folder, pictures));
      ROS_INFO("report: %s/report.html", folder.c_str());
      const std::lock_guard<std::mutex> lock(mutex_);
      state_.report = folder;
      changed_ = true;
    } catch (const std::exception& error) {
      ROS_WARN("no report: %s", oneLine(error.what()).c_str());
    }
  });
  ended_.reset();
}

void TaskSwitch::onTimer() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (std::exchange(changed_, false)) {
    state_.header.stamp = ros::Time::now();
    state_publisher_.publish(state_);
  }
  if (metrics_publisher_.getNumSubscribers() == 0 || !isPast(sent_, kMetricsPeriod_s) || metrics_.styluses.empty())
    return;
  sent_ = TaskClock::now();
  metrics_.header.stamp = ros::Time::now();
  metrics_publisher_.publish(metrics_);
}

}  // namespace viscera::nodes
