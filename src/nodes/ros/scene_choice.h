// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "nodes/ros/parameters.h"
#include "viscera/model/scene/scene.h"

namespace viscera::nodes {

/// The scene that private parameters choose: ~scene, ~mesh, ~mesh_unit_m, ~overrides and ~frame_prefix.
struct SceneChoice {
  std::string scene;         ///< name or path; empty: none
  Overrides mesh;            ///< overrides that ~mesh stands for; none without
  Overrides overrides;       ///< those of ~overrides
  std::string frame_prefix;  ///< of the frames that the simulator sends, for one of several on a master

  /// @param fallback  where ~scene is absent   @throws ParameterError, FileBoundError
  static SceneChoice read(Parameters& parameters, const std::string& fallback);
  /// The scene, fitted to the mesh (fitted_scene.h), with the prefix before its tissue frame.
  /// @param package_folder  where config/scenes/<name>.yaml are looked up
  /// @throws ParameterError, SceneError, FileBoundError
  Scene load(const std::string& package_folder) const;
};

/// A name such as "heart" is <folder>/heart.yaml; what holds a '/' or ends in .yaml is a path.
/// @throws ParameterError  naming `key` and the names there are, if there is no such file
std::string namedFile(const std::string& key, const std::string& value, const std::string& folder);

}  // namespace viscera::nodes
