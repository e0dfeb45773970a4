// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "python/scene_binding.h"

#include <pybind11/stl.h>

#include "model/scene/scene_text.h"
#include "viscera/model/fitted_scene.h"

namespace viscera::python {

namespace py = pybind11;

void SceneSource::load() {
  scene =
      file.empty() ? parseScene(text, label, overrides) : loadFittedScene(file, meshOverrides(mesh), overrides).scene;
}

SceneSource SceneSource::with(const Overrides& more) const {
  SceneSource out = *this;
  out.overrides.insert(out.overrides.end(), more.begin(), more.end());
  out.load();
  return out;
}

namespace {

template <class T>
std::vector<std::string> names(const std::vector<T>& things) {
  std::vector<std::string> out;
  for (const T& thing : things) out.push_back(thing.name);
  return out;
}

}  // namespace

void bindScene(py::module_& module) {
  auto scene = py::class_<SceneSource>(module, "SceneBase", "Base class of viscera.Scene.");
  scene.def(py::init([](const std::string& file, const std::string& text, const std::string& label,
                        const std::string& mesh, const Overrides& overrides) {
              SceneSource out{file, text, label, mesh, overrides, {}};
              out.load();
              return out;
            }),
            py::arg("file"), py::arg("text"), py::arg("label"), py::arg("mesh"), py::arg("overrides"));
  scene.def_property_readonly("name", [](const SceneSource& s) { return s.scene.name; });
  scene.def_property_readonly(
      "file", [](const SceneSource& s) { return s.file; }, "Scene file; empty for a scene from text.");
  scene.def_property_readonly("overrides", [](const SceneSource& s) { return s.overrides; });
  scene.def_property_readonly(
      "styluses", [](const SceneSource& s) { return names(s.scene.styluses); }, "Names.");
  scene.def_property_readonly(
      "bodies", [](const SceneSource& s) { return names(s.scene.bodies); }, "Names.");
  scene.def_property_readonly(
      "cameras", [](const SceneSource& s) { return names(s.scene.cameras); }, "Names.");
  scene.def_property_readonly(
      "tick_s", [](const SceneSource& s) { return 1 / s.scene.solver.tick_hz; }, "Length of a tick [s].");
  scene.def_property_readonly(
      "keys", [](const SceneSource& s) { return sceneText(s.scene); }, "All keys with their values, one per line.");
}

}  // namespace viscera::python
