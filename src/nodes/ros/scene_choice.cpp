// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/ros/scene_choice.h"

#include <filesystem>
#include <set>

#include "math/number_text.h"
#include "model/scene/file_bounds.h"
#include "tasks/task.h"
#include "viscera/model/fitted_scene.h"

namespace viscera::nodes {
namespace {

namespace fs = std::filesystem;

std::string namesIn(const std::string& folder) {
  std::set<std::string> names;
  std::error_code ignored;  // a missing folder has no names
  for (const auto& entry : fs::directory_iterator(folder, ignored))
    if (entry.path().extension() == ".yaml") names.insert(entry.path().stem().string());
  std::string text;
  for (const std::string& name : names) text += " " + name;
  return text;
}

Overrides meshChoice(Parameters& parameters) {
  constexpr double kMinUnit_m = 1e-9, kMaxUnit_m = 1e3;
  const std::string mesh = parameters.text("mesh", "");
  const bool has_unit = parameters.has("mesh_unit_m");
  const double unit_m = parameters.number("mesh_unit_m", 1, kMinUnit_m, kMaxUnit_m);
  if (mesh.empty()) {
    if (has_unit) throw ParameterError("parameter ~mesh_unit_m: is only used with ~mesh; set ~mesh too or remove it");
    return {};
  }
  const fs::path path = fs::absolute(mesh);
  requireWithinBounds(path.string());
  if (!fs::is_regular_file(path))
    throw ParameterError("parameter ~mesh: no file " + path.string() + "; give an absolute path");
  Overrides overrides = meshOverrides(path.string());
  TextOut unit;
  unit.precision(17);
  unit << "bodies[0].unit_scale_m=" << unit_m;
  if (has_unit) overrides.push_back(unit.str());
  return overrides;
}

/// Returns ~frame_prefix. tf2 refuses names that begin with a slash.
std::string framePrefix(Parameters& parameters) {
  const std::string prefix = parameters.text("frame_prefix", "");
  if (prefix.find_first_of("/ \t\n") == 0)
    throw ParameterError("parameter ~frame_prefix: must not begin with '/' or a space; as in left_room/");
  return prefix;
}

}  // namespace

std::string namedPath(const std::string& value, const std::string& folder) {
  const bool is_path = value.find('/') != std::string::npos || fs::path(value).extension() == ".yaml";
  return is_path ? fs::absolute(value).string() : (fs::path(folder) / (value + ".yaml")).string();
}

std::string namedFile(const std::string& key, const std::string& value, const std::string& folder) {
  const fs::path path = namedPath(value, folder);
  if (fs::is_regular_file(path)) return path.string();
  throw ParameterError("parameter ~" + key + ": no file " + path.string() + "; give an absolute path or one of" +
                       namesIn(folder));
}

std::string sceneFile(const std::string& scene, const std::string& package_folder) {
  std::error_code ignored;  // a path that does not exist is kept
  return fs::weakly_canonical(namedPath(scene, package_folder + "/config/scenes"), ignored).string();
}

std::string taskFile(const std::string& key, const std::string& task, const std::string& package_folder) {
  const std::string folder = package_folder + "/config/tasks";
  requireWithinBounds(namedPath(task, folder));
  return namedFile(key, task, folder);
}

SceneChoice SceneChoice::read(Parameters& parameters, const std::string& fallback, const std::string& package_folder) {
  const std::string task = parameters.text("task", "");
  SceneChoice choice{
      parameters.text("scene", task.empty() ? fallback : ""), meshChoice(parameters), {}, framePrefix(parameters)};
  for (const std::string& item : parameters.texts("overrides")) choice.overrides.push_back(item);
  if (task.empty()) return choice;
  choice.task = taskFile("task", task, package_folder);
  const std::string scene = sceneOfTask(loadTask(choice.task), choice.task);
  if (choice.scene.empty()) choice.scene = scene;
  if (sceneFile(choice.scene, package_folder) != sceneFile(scene, package_folder))
    throw ParameterError("parameter ~scene: " + choice.scene + " is not the scene of ~task, " + scene + "; remove it");
  return choice;
}

Scene SceneChoice::load(const std::string& package_folder) const {
  const std::string folder = package_folder + "/config/scenes";
  requireWithinBounds(namedPath(scene, folder));  // otherwise an error would reveal which files exist
  Scene out = loadFittedScene(namedFile("scene", scene, folder), mesh, overrides).scene;
  out.environment.tissue_frame = frame_prefix + out.environment.tissue_frame;
  return out;
}

}  // namespace viscera::nodes
