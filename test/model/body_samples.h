// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "mesh_files.h"
#include "mesh_samples.h"
#include "viscera/math/error.h"
#include "viscera/model/model.h"
#include "viscera/model/scene/scene.h"

namespace viscera::test {

inline Scene sceneOf(const BodyConfig& body) {
  Scene scene;
  scene.bodies = {body};
  return scene;
}

inline BodyConfig boxConfig(const Vector3d& size_m, double spacing_m) {
  BodyConfig config;
  config.name = "slab";
  config.source = TissueSource::kBox;
  config.box_size_m = size_m;
  config.spacing_m = spacing_m;
  return config;
}

inline BodyConfig phantomConfig(double spacing_m) {
  BodyConfig config;
  config.name = "heart";
  config.spacing_m = spacing_m;
  return config;
}

/// Returns a body from a mesh that is written to a file of the running test.
inline BodyConfig meshConfig(const TriangleMesh& mesh, double spacing_m) {
  BodyConfig config;
  config.name = "organ";
  config.source = TissueSource::kMesh;
  config.mesh_file = temporaryPath("organ.obj");
  writeFile(config.mesh_file, objText(mesh));
  config.spacing_m = spacing_m;
  return config;
}

inline Body build(const BodyConfig& config) {
  return buildModel(sceneOf(config)).bodies.at(0);
}

template <typename Expected>
std::string errorOf(const BodyConfig& config) {
  try {
    build(config);
  } catch (const Expected& error) {
    return error.what();
  }
  ADD_FAILURE() << "built without an error";
  return "";
}

inline bool contains(const std::string& text, const std::string& piece) {
  return text.find(piece) != std::string::npos;
}

}  // namespace viscera::test
