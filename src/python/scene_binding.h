// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include <pybind11/pybind11.h>

#include "viscera/model/scene/scene.h"

namespace viscera::python {

/// A scene with what it was made of, so that keys can be set upon it.
struct SceneSource {
  std::string file;   ///< empty: from `text`
  std::string text;   ///< YAML
  std::string label;  ///< stands for the file in messages about `text`
  std::string mesh;   ///< tissue of the first body; empty: what the scene says
  Overrides overrides;
  Scene scene;

  /// @throws SceneError  as the command line's
  void load();
  SceneSource with(const Overrides& more) const;
};

void bindScene(pybind11::module_& module);

}  // namespace viscera::python
