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

/// The scene that private parameters choose: ~scene, ~mesh, ~mesh_unit_m, ~overrides, ~frame_prefix and
/// ~task, whose scene it is where ~scene is absent or empty.
struct SceneChoice {
  std::string scene;         ///< name or path; empty: none
  Overrides mesh;            ///< overrides that ~mesh stands for; none without
  Overrides overrides;       ///< those of ~overrides
  std::string frame_prefix;  ///< of the frames that the simulator sends, for one of several on a master
  std::string task = {};     ///< file of ~task; empty: none

  /// @param fallback  where ~scene is absent, and ~task too   @param package_folder  where config/tasks/<name>.yaml are
  /// @throws ParameterError, FileBoundError, TaskError
  static SceneChoice read(Parameters& parameters, const std::string& fallback, const std::string& package_folder);
  /// The scene, fitted to the mesh (fitted_scene.h), with the prefix before its tissue frame.
  /// @param package_folder  where config/scenes/<name>.yaml are looked up
  /// @throws ParameterError, SceneError, FileBoundError
  Scene load(const std::string& package_folder) const;
};

/// A name such as "heart" is <folder>/heart.yaml; what holds a '/' or ends in .yaml is a path.
/// @throws ParameterError  naming `key` and the names there are, if there is no such file
std::string namedFile(const std::string& key, const std::string& value, const std::string& folder);

/// Of a scene in config/scenes, or a path: where it lies, there or not.
std::string sceneFile(const std::string& scene, const std::string& package_folder);
/// Of a task in config/tasks, or a path. @param key  for errors   @throws ParameterError, FileBoundError
std::string taskFile(const std::string& key, const std::string& task, const std::string& package_folder);

}  // namespace viscera::nodes
