// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/task_run.h"

#include <ctime>
#include <filesystem>
#include <iostream>
#include <utility>

#include "cli/commands.h"
#include "cli/scene_lookup.h"
#include "export/png_writer.h"
#include "math/one_line.h"
#include "tasks/task_notes.h"
#include "tasks/verdict.h"
#include "viscera/math/error.h"
#include "viscera/math/state_hash.h"

namespace viscera::cli {

void requireTrainee(const std::optional<std::string>& name) {
  const std::string fault = name ? traineeFault(*name) : "";
  if (!fault.empty()) throw Error("--name: " + fault);
}

TaskRun::TaskRun(Session& session, std::string folder, bool pictures, std::string trainee, std::string page)
    : session_(session),
      folder_(std::move(folder)),
      pictures_(pictures && !folder_.empty() && !session.scene().cameras.empty()),
      trainee_(std::move(trainee)),
      page_(std::move(page)),
      watch_(session, [this](TaskResult&& result) { ended_.push_back(std::move(result)); }) {}

void TaskRun::begin(const TaskConfig& task) {
  for (const std::string& note : taskNotes(task)) std::cout << "task " << task.name << ": " << note << '\n';
  session_.recordTask(task.name, task.yaml);
  takePicture("at the start", "start");
}

void TaskRun::takePicture(const std::string& caption, const std::string& name) {
  if (!pictures_) return;
  FrameRequest outputs;
  outputs.every_image = true;
  outputs.cameras = {true};
  for (ImageFrame& image : session_.show(outputs).images) {
    std::filesystem::create_directories(folder_);
    writePng(folder_ + "/" + name + ".png", image.width, image.height, image.rgb);
    taken_.push_back({caption, folder_ + "/" + name + ".png"});
  }
}

nlohmann::ordered_json TaskRun::finish() {
  watch_.giveUp("the run ended before the goal was reached");
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  if (!ended_.empty()) takePicture("at the end", "end");
  Attempt attempt = attemptAt(std::time(nullptr), trainee_);
  if (!ended_.empty()) attempt.state_hash = StateHash::text(session_.stateHash());
  for (const TaskResult& result : ended_) {
    out.push_back(toJson(result, attempt));
    const std::string folder = out.size() == 1 ? folder_ : folder_ + "/task_" + std::to_string(out.size());
    lines_.push_back(verdictText(result.task, result.status));
    lines_.push_back(mistakesText(result.task, result.status));
    if (folder_.empty()) continue;
    if (!page_.empty())
      attempt.page = std::filesystem::absolute(page_).lexically_relative(std::filesystem::absolute(folder)).string();
    writeReport(folder, result, attempt, taken_);
    lines_.push_back("Report: " + folder + "/report.html");
  }
  return out;
}

void TaskRun::printVerdicts() const {
  for (const std::string& line : lines_) std::cout << oneLine(line) << '\n';
}

int task(RunOptions options) {
  requireTrainee(options.name);
  const std::string file = findTask(options.task);
  const TaskConfig task = loadTask(file);
  options.task = file;
  options.scene = sceneOfTask(task, file);
  return run(options);
}

}  // namespace viscera::cli
