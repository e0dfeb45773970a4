// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/task_run.h"

#include <filesystem>
#include <iostream>
#include <utility>

#include "cli/commands.h"
#include "cli/png_writer.h"
#include "cli/scene_lookup.h"
#include "tasks/task_notes.h"
#include "tasks/task_picture.h"

namespace viscera::cli {

TaskRun::TaskRun(Session& session, std::string folder, bool pictures)
    : session_(session),
      folder_(std::move(folder)),
      pictures_(pictures && !folder_.empty() && !session.scene().cameras.empty()),
      watch_(session, [this](TaskResult&& result) { ended_.push_back(std::move(result)); }) {}

void TaskRun::begin(const TaskConfig& task) {
  for (const std::string& note : taskNotes(task)) std::cout << "task " << task.name << ": " << note << '\n';
  session_.recordTask(task.name, task.yaml);
  takePicture("at the start", "start");
}

void TaskRun::takePicture(const std::string& caption, const std::string& name) {
  if (!pictures_) return;
  FrameRequest wants;
  wants.every_image = true;
  wants.cameras = {true};
  for (ImageFrame& image : session_.show(wants).images) {
    if (watch_.task()) drawTask(*watch_.task(), session_.scene().cameras[0], image);
    std::filesystem::create_directories(folder_);
    writePng(folder_ + "/" + name + ".png", image.width, image.height, image.rgb);
    taken_.push_back({caption, folder_ + "/" + name + ".png"});
  }
}

nlohmann::ordered_json TaskRun::finish() {
  watch_.giveUp("the run ended before the goal was reached");
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  if (!ended_.empty()) takePicture("at the end", "end");
  for (const TaskResult& result : ended_) {
    out.push_back(toJson(result));
    const std::string folder = out.size() == 1 ? folder_ : folder_ + "/task_" + std::to_string(out.size());
    if (!folder_.empty()) writeReport(folder, result, taken_);
  }
  return out;
}

int task(RunOptions options) {
  const std::string file = findTask(options.task);
  const TaskConfig task = loadTask(file);
  options.task = file;
  options.scene = sceneOfTask(task, file);
  return run(options);
}

}  // namespace viscera::cli
