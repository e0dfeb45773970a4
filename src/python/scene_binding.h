// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <pybind11/pybind11.h>

#include "viscera/model/scene/scene.h"

namespace viscera::python {

/// A scene with its sources, so that keys can be overridden.
struct SceneSource {
  std::string file;   ///< file; empty: from `text`
  std::string text;   ///< YAML
  std::string label;  ///< name that replaces the file in messages about `text`
  std::string mesh;   ///< mesh of the first body; empty: the scene's
  Overrides overrides;
  Scene scene;

  /// Loads the scene. @throws SceneError  as on the command line
  void load();
  SceneSource with(const Overrides& more) const;
};

void bindScene(pybind11::module_& module);

}  // namespace viscera::python
