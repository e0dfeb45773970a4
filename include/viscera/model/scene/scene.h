// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "viscera/model/scene/body_config.h"
#include "viscera/model/scene/camera_config.h"
#include "viscera/model/scene/environment_config.h"
#include "viscera/model/scene/organ_fit.h"
#include "viscera/model/scene/overrides.h"
#include "viscera/model/scene/solver_config.h"
#include "viscera/model/scene/stylus_config.h"
#include "viscera/model/scene/thread_config.h"

namespace viscera {

// Every field of these structs has one entry in src/model/scene/scene_fields.h, which gives its key, unit, range and
// sentence of documentation; the default is the initialiser here. `viscera keys` prints the table. Sources
// that need one section include its header alone, so that a new key recompiles those that use its section or the scene
// as a whole.

/// WHAT is simulated: bodies, tools, cameras and an environment.
struct Scene {
  std::string name = "scene";
  std::vector<BodyConfig> bodies;
  std::vector<StylusConfig> styluses;
  std::vector<CameraConfig> cameras;
  std::vector<ObstacleConfig> obstacles;
  CollisionConfig collision;
  EnvironmentConfig environment;
  SolverConfig solver;
  std::vector<ThreadConfig> threads;
  std::string folder;           ///< of the scene file: relative mesh files are looked up here
  std::string file;             ///< the scene file, for errors; empty for a scene that was not loaded from one
  std::optional<OrganFit> fit;  ///< no key: to an organ that the file was not made for, see fitted_scene.h
};

/// Overrides that make a mesh file, relative to the working directory, the tissue of the first body: centred on the
/// body's origin, upright (glTF's y up is turned to z). None for an empty name. Later overrides go before them.
Overrides meshOverrides(const std::string& mesh_file);

/// Reads and checks a scene file, or the shipped scene of a name such as "heart".
/// @throws SceneError  file, line, key and accepted range, for an unknown key, a wrong type, a value out of range, NaN
Scene loadScene(const std::string& path, const Overrides& overrides = {});

/// The same from text, for tests; `name` stands for the file in messages.
Scene parseScene(const std::string& yaml, const std::string& name, const Overrides& overrides = {});

/// Indices of the bodies whose spacing is to be chosen: `spacing_m: auto` and no target_nodes.
std::vector<size_t> autoBodies(const Scene& scene);

/// Markdown table of every scene key: key, type and unit, default, range, meaning.
std::string sceneKeysTable();

}  // namespace viscera