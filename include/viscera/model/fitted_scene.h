// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "viscera/api.h"
#include "viscera/model/scene/scene.h"

namespace VISCERA_PUBLIC viscera {

/// Scene with an organ in place of the one that it was made for. Fixed regions, obstacles, cameras and tools follow the
/// new organ (OrganFit). In scenes of several bodies only the fixed regions of the first body do.
struct FittedScene {
  Scene scene;          ///< scene with its `fit`, where one was found
  Overrides overrides;  ///< all overrides that were applied to the file
};

/// Loads a scene with a mesh as its first body, fitted to that organ.
/// @param mesh  overrides that make a mesh the first body, see meshOverrides(); none: the scene as in its file
/// @param own   keys set by the user; they take precedence over what follows the organ
/// @throws SceneError, FileBoundError  as loadScene(). Nothing follows an organ that cannot be read or is out of all
/// proportion; buildModel() then reports what is wrong.
FittedScene loadFittedScene(const std::string& path, const Overrides& mesh, const Overrides& own);

/// Returns the file with its overrides as a scene file that can be moved: file names in it are absolute.
/// @throws SceneError
std::string sceneYaml(const std::string& path, const Overrides& overrides, const std::string& remark);

}  // namespace viscera
