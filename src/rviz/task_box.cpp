// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/task_box.h"

#if __has_include(<viscera/TaskState.h>)
#include <rviz/yaml_config_reader.h>
#include <std_srvs/Trigger.h>
#include <viscera/LoadScene.h>
#include <viscera/Metrics.h>
#include <viscera/StartTask.h>
#include <viscera/TaskState.h>

#include <QDir>
#include <QFileInfo>
#include <QGridLayout>
#include <QLineEdit>
#include <QProgressBar>
#include <QPushButton>
#include <QUrl>
#include <QVBoxLayout>
#include <algorithm>

#include "nodes/received/ros_worker.h"
#include "rviz/panel_style.h"
#include "rviz/task_words.h"

namespace viscera::rviz_plugin {
namespace {

constexpr int kPercent = 100;
constexpr double kMillimetres = 1e3;

QString number(double value, int digits) {
  return QString::number(value, 'f', digits);
}

QString verdictStyle(uint8_t state) {
  if (state == TaskState::PASSED) return "color: #007a58; font-weight: bold";
  return state == TaskState::FAILED ? "color: #c04000; font-weight: bold" : "";
}

QString scoreText(const TaskState& state) {
  QString out = number(state.time_s, 1) + " of " + number(state.time_limit_s, 0) + " s";
  if (state.proficiency_s > 0) out += " (proficient: " + number(state.proficiency_s, 0) + " s)";
  out += ", penalties " + number(state.penalties_s, 1) + " s";
  if (state.state == TaskState::PASSED) out += ": PASSED";
  if (state.state == TaskState::FAILED) out += ": FAILED";
  return out;
}

QString measuresText(const TaskState& state) {
  std::vector<SentMeasure> measures;
  const size_t count = std::min({state.measures.size(), state.values.size(), state.measure_penalties_s.size()});
  for (size_t i = 0; i < count; ++i)
    measures.push_back({state.measures[i], state.values[i], state.measure_penalties_s[i]});
  return measuresText(state.kind, measures);
}

/// Returns the scene that a task's file names, in the format of load_scene; empty if the file cannot be read.
std::string sceneOf(const QString& task_file) {
  rviz::Config task;
  rviz::YamlConfigReader reader;
  reader.readFile(task, task_file);
  QString scene;
  if (reader.error() || !task.mapGetString("scene", &scene)) return {};
  const bool named = !scene.contains('/') && !scene.endsWith(".yaml");
  return (named ? scene : QDir(QFileInfo(task_file).path()).filePath(scene)).toStdString();
}

/// Starts a task, and loads its scene first if the simulator requires it.
/// @param file  file of the task, if it is on this machine   @returns a text for the user
std::string startTask(received::RosWorker& worker, const std::string& space, const std::string& task,
                      const QString& file) {
  StartTaskRequest request;
  request.task = task;
  received::RosWorker::Answer answer = worker.ask<StartTask>(space + "start_task", request);
  if (answer.success || answer.text.find(StartTaskResponse::LOAD_SCENE_FIRST) == std::string::npos) return answer.text;
  LoadSceneRequest scene;
  scene.scene = sceneOf(file);
  if (scene.scene.empty()) return answer.text;
  answer = worker.ask<LoadScene>(space + "load_scene", scene);
  return answer.success ? worker.ask<StartTask>(space + "start_task", request).text : answer.text;
}

QString toolsText(const Metrics& metrics) {
  QString out;
  const size_t count = std::min({metrics.styluses.size(), metrics.time_s.size(), metrics.path_m.size(),
                                 metrics.economy.size(), metrics.peak_force_n.size(), metrics.sparc.size()});
  for (size_t i = 0; i < count; ++i) {
    out += QString("%1: %2 s, path %3 mm, economy %4, at most %5 N")
               .arg(QString::fromStdString(metrics.styluses[i]), number(metrics.time_s[i], 1),
                    number(kMillimetres * metrics.path_m[i], 0), number(metrics.economy[i], 2),
                    number(metrics.peak_force_n[i], 2));
    out += metrics.complete ? ", smoothness " + number(metrics.sparc[i], 2) + "\n" : "\n";
  }
  return out.trimmed();
}

/// Writes a text, and hides the label if it is empty.
void writeOrHide(QLabel* label, const QString& text) {
  label->setText(text);
  label->setVisible(!text.isEmpty());
}

}  // namespace

struct TaskBox::Inside {
  /// Subscribed on the worker's thread.
  struct Topics {
    ros::Subscriber state, metrics;
  };
  received::RosWorker& worker;
  std::string space;
  QString folder;  ///< folder of tasks with names
  bool runs = false, busy = false;
  QWidget* choices = new QWidget;
  QComboBox* tasks = new ChoiceBox;
  QPushButton* start = new QPushButton(icon(Sign::kStart), "Start");
  QPushButton* end = new QPushButton(icon(Sign::kEnd), "Give up");
  QLabel *text = wrappedLabel(), *score = wrappedLabel(), *measures = wrappedLabel(), *tools = wrappedLabel(),
         *report = new QLabel;
  QProgressBar* progress = new QProgressBar;
  PassBar* score_bar = new PassBar;
  std::shared_ptr<Topics> topics = std::make_shared<Topics>();

  void clear();
  void show(const TaskState& state);
  void enable() {
    start->setEnabled(runs);
    end->setEnabled(runs && busy);
  }
};

TaskBox::TaskBox(received::RosWorker& worker) : QGroupBox("Task"), inside_(new Inside{worker, {}, {}}) {
  Inside& in = *inside_;
  in.tasks->setEditable(true);
  in.tasks->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  in.tasks->setMinimumContentsLength(kLeastLetters);
  in.tasks->setToolTip("Name of a task, or path of one");
  in.progress->setRange(0, kPercent);
  in.progress->setFormat("%p % of the goal");
  in.report->setOpenExternalLinks(true);
  auto* grid = new QGridLayout(in.choices);
  grid->setContentsMargins(0, 0, 0, 0);
  grid->addWidget(in.tasks, 0, 0, 1, 2);
  grid->addWidget(in.start, 1, 0);
  grid->addWidget(in.end, 1, 1);
  auto* rows = new QVBoxLayout(this);
  for (QWidget* widget :
       {static_cast<QWidget*>(in.text), static_cast<QWidget*>(in.progress), static_cast<QWidget*>(in.score_bar),
        static_cast<QWidget*>(in.score), static_cast<QWidget*>(in.measures), static_cast<QWidget*>(in.tools),
        static_cast<QWidget*>(in.report)})
    rows->addWidget(widget);
  connect(in.start, &QPushButton::clicked, this, [&in] {
    const QString task = in.tasks->currentText().trimmed();
    const QString file = task.contains('/') ? task : QDir(in.folder).filePath(task + ".yaml");
    in.tasks->lineEdit()->clearFocus();
    in.worker.add([&worker = in.worker, space = in.space, task = task.toStdString(), file] {
      return startTask(worker, space, task, file);
    });
  });
  connect(in.end, &QPushButton::clicked, this, [&in] { in.worker.call<std_srvs::Trigger>(in.space + "end_task", {}); });
  in.clear();
}

TaskBox::~TaskBox() = default;

void TaskBox::follow(const ros::NodeHandle& node, const std::string& space) {
  Inside& in = *inside_;
  in.space = space;
  in.clear();
  in.worker.add([&in, node = node, space, topics = in.topics]() mutable {
    topics->state.shutdown();
    topics->metrics.shutdown();
    if (space.empty()) return std::string();
    topics->state = node.subscribe<TaskState>(space + "task_state", 1,
                                              [&in](const TaskStateConstPtr& message) { in.show(*message); });
    topics->metrics = node.subscribe<Metrics>(
        space + "metrics", 1, [&in](const MetricsConstPtr& message) { writeOrHide(in.tools, toolsText(*message)); });
    return std::string();
  });
}

QWidget* TaskBox::choices() const {
  return inside_->choices;
}

void TaskBox::offerTasks(const QStringList& names, const QString& folder) {
  inside_->folder = folder;
  offer(inside_->tasks, names);
}

void TaskBox::setRuns(bool runs) {
  inside_->runs = runs;
  inside_->enable();
}

void TaskBox::Inside::clear() {
  for (QLabel* label : {text, score, measures, tools, report}) label->hide();
  progress->hide();
  score_bar->hide();
  busy = false;
  enable();
}

void TaskBox::Inside::show(const TaskState& state) {
  if (state.state == TaskState::NONE) return clear();
  busy = state.state == TaskState::WAITING || state.state == TaskState::RUNNING;
  enable();
  choose(tasks, QString::fromStdString(state.task));
  writeOrHide(text, QString::fromStdString(state.title + "\n" + state.instructions +
                                           (state.step.empty() ? "" : "\n\n" + state.step)));
  writeOrHide(score, scoreText(state));
  score->setStyleSheet(verdictStyle(state.state));
  progress->setValue(static_cast<int>(kPercent * std::clamp(state.progress, 0.0, 1.0)));
  progress->show();
  const ScoreBar bar = scoreBar(state.score, state.pass_score, state.time_limit_s);
  score_bar->show(bar.share, bar.pass_share, bar.passes && state.state != TaskState::FAILED, bar.text);
  writeOrHide(measures, measuresText(state));
  const QString page = QUrl::fromLocalFile(QString::fromStdString(state.report) + "/report.html").toString();
  writeOrHide(report, state.report.empty() ? QString() : "<a href=\"" + page.toHtmlEscaped() + "\">Report</a>");
}

}  // namespace viscera::rviz_plugin

#else  // the messages lack those of tasks

namespace viscera::rviz_plugin {

struct TaskBox::Inside {};

TaskBox::TaskBox(received::RosWorker&) {
  hide();
}
TaskBox::~TaskBox() = default;
void TaskBox::follow(const ros::NodeHandle&, const std::string&) {}
QWidget* TaskBox::choices() const {
  return new QWidget;
}
void TaskBox::offerTasks(const QStringList&, const QString&) {}
void TaskBox::setRuns(bool) {}

}  // namespace viscera::rviz_plugin
#endif
