// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/simulator/status_watch.h"

#include <ros/master.h>
#include <ros/spinner.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <cstdio>

#include "nodes/ros/master_watch.h"

namespace viscera::nodes {
namespace {

constexpr std::chrono::milliseconds kPoll{100};  ///< time until the first screen is shown and a lost master detected
constexpr std::chrono::seconds kPeriod{1};
constexpr const char* kStarting = "Node starting up";  ///< message of diagnostic_updater before the first report
constexpr const char* kHomeAndClear = "\033[H\033[J";

size_t columnsOf(int terminal, size_t fallback) {
  winsize size{};
  return ioctl(terminal, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : fallback;
}

void show(const std::string& screen) {
  std::fputs(((isatty(STDOUT_FILENO) ? kHomeAndClear : "") + screen).c_str(), stdout);
  if (!isatty(STDOUT_FILENO)) std::fputc('\n', stdout);
  std::fflush(stdout);
}

}  // namespace

StatusOptions statusOptions(Parameters& parameters) {
  StatusOptions options;
  options.once = parameters.flag("once", options.once);
  options.simulator = parameters.text("simulator", options.simulator);
  parameters.refuseOthers();
  if (!options.simulator.empty() && options.simulator[0] == '/') options.simulator.erase(0, 1);
  return options;
}

StatusWatch::StatusWatch(const StatusOptions& options) : options_(options) {
  diagnostics_ = node_.subscribe("/diagnostics", 100, &StatusWatch::onDiagnostics, this);
}

void StatusWatch::onDiagnostics(const diagnostic_msgs::DiagnosticArray& message) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (const diagnostic_msgs::DiagnosticStatus& said : message.status) {
    const size_t colon = said.name.find(": ");
    if (said.message == kStarting || colon == std::string::npos) continue;
    Heard heard;
    heard.status.node = said.name.substr(said.name[0] == '/' ? 1 : 0, colon - (said.name[0] == '/' ? 1 : 0));
    heard.status.part = said.name.substr(colon + 2);
    heard.status.level = said.level;
    heard.status.message = said.message;
    for (const diagnostic_msgs::KeyValue& value : said.values) heard.status.values[value.key] = value.value;
    heard.at = Clock::now();
    heard_[{heard.status.node, heard.status.part}] = heard;
  }
}

std::vector<ReceivedStatus> StatusWatch::statuses() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  std::vector<ReceivedStatus> out;
  for (const auto& [key, heard] : heard_) {
    out.push_back(heard.status);
    out.back().age_s = std::chrono::duration<double>(Clock::now() - heard.at).count();
  }
  return out;
}

StatusView StatusWatch::view() const {
  StatusView view;
  view.simulator = options_.simulator;
  view.master_uri = ros::master::getURI();
  view.columns = columnsOf(STDOUT_FILENO, view.columns);
  view.watched_s = std::chrono::duration<double>(Clock::now() - begun_).count();
  return view;
}

bool StatusWatch::run(EndWatch& end) {
  ros::AsyncSpinner spinner(1);
  spinner.start();
  MasterWatch master;
  Clock::time_point due = Clock::now();
  bool found = false;
  while (!end.waitFor(kPoll)) {
    master.require();
    const std::vector<ReceivedStatus> said = statuses();
    const StatusView now = view();
    found = isSimulatorKnown(said, now);
    const bool enough = found || now.watched_s >= kSilent_s;
    if (options_.once ? !enough : Clock::now() < due) continue;
    show(statusScreen(said, now));
    if (options_.once) break;
    due = Clock::now() + kPeriod;
  }
  return found;
}

}  // namespace viscera::nodes
