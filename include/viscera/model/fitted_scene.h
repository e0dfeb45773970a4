// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viscera/model/scene/scene.h"

namespace viscera {

/// A scene whose first body is another organ than the one it was made for, which its fixed regions, obstacles, cameras
/// and tools follow (OrganFit). Scenes of several bodies: its fixed regions alone do.
struct FittedScene {
  Scene scene;          ///< with its `fit`, where one was found
  Overrides overrides;  ///< all that were put upon the file
};

/// @param mesh  overrides that make a mesh the first body, see meshOverrides(); none: the scene as its file has it
/// @param own   keys that were set, which go before what follows the organ
/// @throws SceneError, FileBoundError  as loadScene(). An organ that cannot be read or is out of all proportion is
/// followed by nothing: making a model of it says what is wrong.
FittedScene loadFittedScene(const std::string& path, const Overrides& mesh, const Overrides& own);

/// The file with its overrides as a scene file that stands anywhere: names of files in it are absolute.
/// @throws SceneError
std::string sceneYaml(const std::string& path, const Overrides& overrides, const std::string& remark);

}  // namespace viscera
