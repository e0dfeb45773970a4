// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "viscera/api.h"
#include "viscera/model/scene/attachment_config.h"
#include "viscera/model/scene/body_config.h"
#include "viscera/model/scene/camera_config.h"
#include "viscera/model/scene/environment_config.h"
#include "viscera/model/scene/mark_config.h"
#include "viscera/model/scene/organ_fit.h"
#include "viscera/model/scene/overrides.h"
#include "viscera/model/scene/solver_config.h"
#include "viscera/model/scene/stylus_config.h"
#include "viscera/model/scene/suture_config.h"

namespace VISCERA_PUBLIC viscera {

// Every field of these structs has one entry in src/model/scene/scene_fields.h with its key, unit, range and
// documentation; the default is the initialiser here. `viscera keys` prints the table. A source that needs one section
// includes the header of that section only, so that a new key recompiles few sources.

/// Description of a simulation: bodies, tools, cameras and an environment.
struct Scene {
  std::string name = "scene";
  std::vector<BodyConfig> bodies;
  std::vector<StylusConfig> styluses;
  std::vector<CameraConfig> cameras;
  std::vector<ObstacleConfig> obstacles;
  CollisionConfig collision;
  EnvironmentConfig environment;
  SolverConfig solver;
  std::vector<SutureConfig> sutures;
  std::vector<MarkConfig> marks;
  std::vector<AttachmentConfig> attachments;
  Look look = Look::kPlain;
  std::string folder;           ///< folder of the scene file: relative mesh files are looked up here
  std::string file;             ///< scene file, for errors; empty for a scene that was not loaded from a file
  std::optional<OrganFit> fit;  ///< no key: fit to an organ that the file was not made for, see fitted_scene.h
};

/// Returns overrides that make a mesh file the tissue of the first body. The path is relative to the working directory;
/// the mesh is centred on the body's origin and upright (glTF's y up is turned to z). None for an empty name. Later
/// overrides win over them.
Overrides meshOverrides(const std::string& mesh_file);

/// Reads and checks a scene file, or the shipped scene of a name such as "heart".
/// @throws SceneError  file, line, key and accepted range, for an unknown key, a wrong type, a value out of range, NaN
Scene loadScene(const std::string& path, const Overrides& overrides = {});

/// Reads and checks a scene from text, for tests; `name` is the file name in messages.
Scene parseScene(const std::string& yaml, const std::string& name, const Overrides& overrides = {});

/// Returns the indices of the bodies with a spacing to be chosen: `spacing_m: auto` and no target_nodes.
std::vector<size_t> autoBodies(const Scene& scene);

/// Returns a Markdown table of every scene key: key, type and unit, default, range, meaning.
std::string sceneKeysTable();

}  // namespace viscera