// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/session_panel.h"

#include <ros/node_handle.h>
#include <ros/package.h>
#include <rviz/visualization_manager.h>
#include <std_srvs/Trigger.h>
#include <viscera/FileCommand.h>
#include <viscera/LoadScene.h>
#include <viscera/SetToolMode.h>
#include <viscera/Step.h>

#include <QDateTime>
#include <QDir>
#include <QFormLayout>
#include <QLineEdit>
#include <QPushButton>
#include <QScrollArea>
#include <QSpinBox>
#include <QTimer>
#include <QVBoxLayout>
#include <algorithm>
#include <pluginlib/class_list_macros.hpp>
#include <utility>

#include "nodes/received/ros_worker.h"
#include "nodes/received/simulator_space.h"
#include "rviz/panel_style.h"
#include "rviz/task_box.h"
#include "rviz/tool_table.h"

namespace viscera::rviz_plugin {
namespace {

constexpr int kShowEvery_ms = 250;
constexpr int kMostTicks = 10000;  // limit of one call of the service
constexpr int kStateLines = 4;     // lines in a narrow dock, with the file of a recording
constexpr const char* kPause = "Pa&use";
constexpr const char* kResume = "Res&ume";
constexpr const char* kRecord = "Re&cord";
constexpr const char* kStopRecording = "Stop re&cording";
constexpr uint32_t kDiagnosticsQueue = 100;

QStringList yamlNames(const std::string& folder) {
  QStringList names;
  for (const QFileInfo& file : QDir(QString::fromStdString(folder)).entryInfoList({"*.yaml"}, QDir::Files, QDir::Name))
    names += file.completeBaseName();
  return names;
}

QComboBox* writable(const char* hint) {
  auto* box = new ChoiceBox;
  box->setEditable(true);
  box->setInsertPolicy(QComboBox::NoInsert);
  box->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  box->setMinimumContentsLength(kLeastLetters);
  box->lineEdit()->setPlaceholderText(hint);
  return box;
}

}  // namespace

/// Shared with the worker's thread, which creates them.
struct PanelTopics {
  ros::Subscriber diagnostics;
};

SessionPanel::SessionPanel(QWidget* parent)
    : rviz::Panel(parent),
      state_(steadyLabel(kStateLines)),
      measures_(wrappedLabel()),
      warnings_(wrappedLabel()),
      answer_(wrappedLabel()),
      tools_(new ToolTable([this](const std::string& stylus, const std::string& which, const std::string& mode) {
        SetToolModeRequest request;
        request.stylus = stylus;
        request.which = which;
        request.mode = mode;
        call<SetToolMode>("set_tool_mode", request);
      })),
      topics_(std::make_shared<PanelTopics>()) {
  warnings_->setStyleSheet("color: #c04000");
  auto* inside = new QWidget;
  auto* rows = new QVBoxLayout(inside);
  worker_ = std::make_unique<received::RosWorker>([this](const std::string& text) {
    QMetaObject::invokeMethod(
        this, [this, text] { write(answer_, QString::fromStdString(text)); }, Qt::QueuedConnection);
  });
  task_ = new TaskBox(*worker_);
  makeChoices(rows);
  makeButtons(rows);
  // Widgets to click come first, and those of variable height last: a button that moves is missed.
  for (QWidget* widget :
       {static_cast<QWidget*>(state_), static_cast<QWidget*>(tools_), static_cast<QWidget*>(answer_),
        static_cast<QWidget*>(warnings_), static_cast<QWidget*>(task_), static_cast<QWidget*>(measures_)})
    rows->addWidget(widget);
  rows->addStretch(1);
  auto* scroll = new QScrollArea;  // a dock may be low
  scroll->setWidgetResizable(true);
  scroll->setFrameShape(QFrame::NoFrame);
  scroll->setVerticalScrollBarPolicy(Qt::ScrollBarAlwaysOn);  // appearing later, it would take room from the buttons
  scroll->setWidget(inside);
  auto* all = new QVBoxLayout(this);
  all->setContentsMargins(0, 0, 0, 0);
  all->addWidget(scroll);
}

SessionPanel::~SessionPanel() {
  worker_.reset();
}

void SessionPanel::makeChoices(QVBoxLayout* rows) {
  auto* form = new QFormLayout;
  spaces_ = writable("namespace of rviz");
  spaces_->setToolTip("Namespace of the simulator");
  form->addRow("Simulator", spaces_);
  scenes_ = writable("scene, or path of one");
  load_ = new QPushButton(icon(Sign::kLoad), "Load");
  auto* line = new QHBoxLayout;
  line->addWidget(scenes_, 1);
  line->addWidget(load_);
  form->addRow("Scene", line);
  form->addRow("Task", task_->choices());
  rows->addLayout(form);
  const auto chosen = [this] { chooseSpace(spaces_->currentText().trimmed().toStdString()); };
  connect(spaces_, QOverload<int>::of(&QComboBox::activated), this, chosen);
  connect(spaces_->lineEdit(), &QLineEdit::editingFinished, this, chosen);
  connect(load_, &QPushButton::clicked, this, [this] {
    LoadSceneRequest request;
    request.scene = scenes_->currentText().trimmed().toStdString();
    scenes_->lineEdit()->clearFocus();  // from here on it shows the running scene
    call<LoadScene>("load_scene", request);
  });
}

void SessionPanel::makeButtons(QVBoxLayout* rows) {
  reset_ = new QPushButton(icon(Sign::kReset), "&Reset");
  pause_ = new QPushButton(icon(Sign::kPause), kPause);
  step_ = new QPushButton(icon(Sign::kStep), "S&tep");
  record_ = new QPushButton(icon(Sign::kRecord), kRecord);
  keepWidthOf(pause_, {kPause, kResume});
  keepWidthOf(record_, {kRecord, kStopRecording});
  ticks_ = new CountBox;
  ticks_->setRange(1, kMostTicks);
  ticks_->setSuffix(" ticks");
  auto* grid = new QGridLayout;
  grid->addWidget(reset_, 0, 0);
  grid->addWidget(pause_, 0, 1);
  grid->addWidget(step_, 1, 0);
  grid->addWidget(ticks_, 1, 1);
  grid->addWidget(record_, 2, 0, 1, 2);
  for (QWidget* widget : {static_cast<QWidget*>(reset_), static_cast<QWidget*>(pause_), static_cast<QWidget*>(step_),
                          static_cast<QWidget*>(ticks_), static_cast<QWidget*>(record_)})
    widget->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Fixed);  // halves of the panel, whatever their texts
  grid->setColumnStretch(0, 1);
  grid->setColumnStretch(1, 1);
  rows->addLayout(grid);
  connect(reset_, &QPushButton::clicked, this, [this] { call<std_srvs::Trigger>("reset"); });
  connect(pause_, &QPushButton::clicked, this, [this] { call<std_srvs::Trigger>(now_.paused ? "resume" : "pause"); });
  connect(record_, &QPushButton::clicked, this, [this] { record(); });
  connect(step_, &QPushButton::clicked, this, [this] {
    StepRequest request;
    request.ticks = static_cast<uint32_t>(ticks_->value());
    call<Step>("step", request);
  });
}

template <class Service>
void SessionPanel::call(const char* service, const typename Service::Request& request) {
  if (!space_.empty()) worker_->call<Service>(space_ + service, request);
}

void SessionPanel::record() {
  if (!now_.recording.empty()) return call<std_srvs::Trigger>("stop_recording");
  FileCommandRequest request;  // named like those of ~record
  request.file = QDateTime::currentDateTimeUtc().toString("'session_'yyyyMMdd'T'hhmmss'Z.viscera'").toStdString();
  call<FileCommand>("start_recording", request);
}

void SessionPanel::onInitialize() {
  follow();
  worker_->add([this] {
    const std::string package = ros::package::getPath("viscera");
    const std::string folder = package + "/config/tasks";
    const QStringList scenes = yamlNames(package + "/config/scenes"), tasks = yamlNames(folder);
    const auto offerBoth = [this, scenes, tasks, folder] {
      offer(scenes_, scenes);
      task_->offerTasks(tasks, QString::fromStdString(folder));
    };
    QMetaObject::invokeMethod(this, offerBoth, Qt::QueuedConnection);
    return std::string();
  });
  auto* timer = new QTimer(this);
  connect(timer, &QTimer::timeout, this, [this] { show(); });
  timer->start(kShowEvery_ms);
  space_.clear();
  chooseSpace(wanted_);
}

/// Subscribes on the worker's thread, since a master may be slow to answer.
void SessionPanel::follow() {
  worker_->add([this, node = queued(), topics = topics_]() mutable {
    topics->diagnostics = node.subscribe<diagnostic_msgs::DiagnosticArray>(
        "/diagnostics", kDiagnosticsQueue, [this](const diagnostic_msgs::DiagnosticArrayConstPtr& message) {
          simulators_.take(*message, std::chrono::steady_clock::now());
        });
    return std::string();
  });
}

/// Returns a handle with callbacks on rviz's own thread.
ros::NodeHandle SessionPanel::queued() const {
  ros::NodeHandle node;
  node.setCallbackQueue(vis_manager_->getUpdateQueue());
  return node;
}

/// Chooses the namespace. @param space  as the user wrote it
void SessionPanel::chooseSpace(const std::string& space) {
  const bool changed = std::exchange(wanted_, space) != space;
  const std::string before = space_;
  try {
    space_ = received::simulatorSpace(space);
  } catch (const ros::InvalidNameException&) {
    space_.clear();
  }
  if (vis_manager_ && space_ != before) task_->follow(queued(), space_);
  show();
  if (changed) Q_EMIT configChanged();
}

void SessionPanel::show() {
  const std::vector<received::DiscoveredSimulator> simulators = simulators_.at(std::chrono::steady_clock::now());
  std::vector<received::DiscoveredSimulator> here;
  QStringList spaces;
  for (const received::DiscoveredSimulator& simulator : simulators) {
    if (simulator.space() == space_) here.push_back(simulator);
    spaces += QString::fromStdString(simulator.space());
  }
  spaces.removeDuplicates();
  offer(spaces_, spaces);
  choose(spaces_, QString::fromStdString(wanted_));
  const std::string scene_before = now_.scene;
  now_ = here.empty() ? received::DiscoveredSimulator() : here.front();
  if (now_.scene != scene_before) choose(scenes_, QString::fromStdString(now_.scene));
  write(state_, QString::fromStdString(stateText(here)));
  showSession(here);
}

std::string SessionPanel::stateText(const std::vector<received::DiscoveredSimulator>& here) const {
  if (space_.empty()) return "'" + wanted_ + "' is not a valid namespace";
  if (here.empty()) return "no simulator in " + space_ + " sends /diagnostics";
  std::string text = now_.node + ": " + now_.state;
  if (!now_.scene.empty()) text += ", scene " + now_.scene;
  if (!now_.tick.empty()) text += ", tick " + now_.tick;
  if (!now_.paused && !now_.real_time_factor.empty())
    text += ", " + rounded(now_.real_time_factor, 2).toStdString() + " of real time";
  if (!now_.preparing_percent.empty())
    text += (now_.scene.empty() ? "\npreparing: " : "\nload_scene: ") + now_.preparing_percent + " %";
  if (!now_.recording.empty()) text += "\nrecording into " + now_.recording.substr(now_.recording.rfind('/') + 1);
  return text;
}

void SessionPanel::showSession(const std::vector<received::DiscoveredSimulator>& here) {
  QString warnings;
  for (const received::DiscoveredSimulator& other : here)
    if (other.node != now_.node)
      warnings += QString::fromStdString(other.node + " is also in this namespace; services belong to the last one\n");
  for (const std::string& warning : now_.warnings) warnings += QString::fromStdString(warning) + "\n";
  warnings_->setText(warnings.trimmed());
  const bool runs = !now_.scene.empty();
  measures_->setText(!runs ? QString()
                           : QString("Springs cut: %1, largest stretch %2")
                                 .arg(QString::fromStdString(now_.springs_cut), rounded(now_.max_stretch, 3)));
  pause_->setText(now_.paused ? kResume : kPause);
  pause_->setIcon(icon(now_.paused ? Sign::kResume : Sign::kPause));
  record_->setText(now_.recording.empty() ? kRecord : kStopRecording);
  record_->setIcon(icon(now_.recording.empty() ? Sign::kRecord : Sign::kStop));
  for (QWidget* button : {reset_, pause_, load_, record_}) button->setEnabled(runs);
  step_->setEnabled(now_.paused);
  task_->setRuns(runs);
  tools_->show(now_.styluses);
}

void SessionPanel::load(const rviz::Config& config) {
  rviz::Panel::load(config);
  QString space;
  if (config.mapGetString("Namespace", &space)) chooseSpace(space.trimmed().toStdString());
}

void SessionPanel::save(rviz::Config config) const {
  rviz::Panel::save(config);
  config.mapSetValue("Namespace", QString::fromStdString(wanted_));
}

}  // namespace viscera::rviz_plugin

PLUGINLIB_EXPORT_CLASS(viscera::rviz_plugin::SessionPanel, rviz::Panel)
