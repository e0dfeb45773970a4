// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// The compiled part of the Python package viscera; the Python part is viscera/__init__.py in this folder.
#include "python/arrays.h"
#include "python/scene_binding.h"
#include "python/session_binding.h"
#include "python/stylus_binding.h"
#include "python/vector_binding.h"
#include "viscera/math/error.h"

PYBIND11_MODULE(_viscera, module) {
  using namespace viscera;
  namespace py = pybind11;
  module.attr("__version__") = VISCERA_VERSION;
  const auto& error = py::register_exception<Error>(module, "Error", PyExc_RuntimeError);
  py::register_exception<SceneError>(module, "SceneError", error);
  py::register_exception<MeshError>(module, "MeshError", error);
  py::register_exception<LatticeError>(module, "LatticeError", error);
  py::register_exception<GpuError>(module, "GpuError", error);
  python::bindMemory(module);
  python::bindStylus(module);
  python::bindScene(module);
  python::bindSession(module);
  python::bindVector(module);
}
