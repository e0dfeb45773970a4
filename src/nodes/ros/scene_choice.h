// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "nodes/ros/parameters.h"
#include "viscera/model/scene/overrides.h"

namespace viscera {
struct Scene;
}

namespace viscera::nodes {

/// The scene that the private parameters choose: ~scene, ~mesh, ~mesh_unit_m, ~overrides, ~frame_prefix and ~task. If
/// ~scene is absent or empty, it is the scene of ~task.
struct SceneChoice {
  std::string scene;         ///< name or path of the scene; empty: none
  Overrides mesh;            ///< overrides for ~mesh; empty without ~mesh
  Overrides overrides;       ///< overrides from ~overrides
  std::string frame_prefix;  ///< prefix of the frames that the simulator sends, for several simulators on one master
  std::string task = {};     ///< file of ~task; empty: none

  /// Reads the parameters.
  /// @param fallback  scene if both ~scene and ~task are absent
  /// @param package_folder  folder with config/tasks/<name>.yaml
  /// @throws ParameterError, FileBoundError, TaskError
  static SceneChoice read(Parameters& parameters, const std::string& fallback, const std::string& package_folder);
  /// Returns the scene, fitted to the mesh (fitted_scene.h), with the prefix added to its tissue frame.
  /// @param package_folder  folder with config/scenes/<name>.yaml
  /// @throws ParameterError, SceneError, FileBoundError
  Scene load(const std::string& package_folder) const;
};

/// Returns the path of a named file: a name such as "heart" is <folder>/heart.yaml; a name with '/' or ending in .yaml
/// is a path.
/// @throws ParameterError  there is no such file; names `key` and the available names
std::string namedFile(const std::string& key, const std::string& value, const std::string& folder);

/// Returns the path of a scene in config/scenes, or the given path, whether the file exists or not.
std::string sceneFile(const std::string& scene, const std::string& package_folder);
/// Returns the path of a task in config/tasks, or the given path.
/// @param key  for errors   @throws ParameterError, FileBoundError
std::string taskFile(const std::string& key, const std::string& task, const std::string& package_folder);

}  // namespace viscera::nodes
