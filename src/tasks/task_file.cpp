// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>

#include "math/number_text.h"
#include "model/scene/key_table.h"
#include "model/scene/yaml/yaml_reader.h"
#include "tasks/task_fields.h"

namespace viscera {

namespace {

void requireWhole(const TaskConfig& task, const std::string& where) {
  if (task.scene.empty())
    throw TaskError(where + ": 'scene' must name a scene in config/scenes or a file in the same folder");
  const std::string fault = kindOf(task.kind).fault(task);
  if (!fault.empty()) throw TaskError(where + ": " + fault);
  if (task.pass_score > task.time_limit_s)
    throw TaskError(where + ": 'pass_score' must be 0 .. " + numberText(task.time_limit_s) +
                    ", 'time_limit_s'; found " + numberText(task.pass_score));
}

}  // namespace

TaskConfig parseTask(const std::string& yaml, const std::string& where) {
  YamlSource source{where, {}};
  TaskConfig task;
  try {
    const YAML::Node root = YAML::Load(yaml);
    if (!root.IsMap()) throw TaskError(where + ": a task must be a map of keys; `viscera keys task` lists them");
    YamlReader::readMap(root, "", source, task);
  } catch (const YAML::Exception& error) {
    throw TaskError(yamlFault(where, error, yaml));
  } catch (const SceneError& error) {
    throw TaskError(error.what());
  }
  task.name = std::filesystem::path(where).stem().string();
  task.yaml = yaml;
  requireWhole(task, where);
  return task;
}

TaskConfig loadTask(const std::string& path) {
  try {
    return parseTask(textOf(path, "task"), path);
  } catch (const SceneError& error) {
    throw TaskError(error.what());
  }
}

std::string sceneOfTask(const TaskConfig& task, const std::string& task_file) {
  const std::filesystem::path scene(task.scene);
  if (scene.is_absolute() || (task.scene.find('/') == std::string::npos && scene.extension() != ".yaml")) return scene;
  return (std::filesystem::path(task_file).parent_path() / scene).string();
}

std::string taskKeysTable() {
  TextOut out;
  out << keyTable<TaskConfig>() << "\n| measure | meaning |\n|---|---|\n";
  for (const TaskMeasure& measure : kTaskMeasures) out << "| `" << measure.name << "` | " << measure.meaning << " |\n";
  return out.str();
}

}  // namespace viscera
