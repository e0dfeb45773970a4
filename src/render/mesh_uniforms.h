// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "gpu/gl.h"
#include "gpu/program.h"
#include "viscera/render/camera.h"

namespace viscera {

/// Sets the uniforms of shaders/draw/mesh.vert.
inline void setMeshMatrices(const gpu::Program& program, const Pose& optical_from_mesh,
                            const Eigen::Matrix4f& clip_from_optical) {
  const Eigen::Matrix4f optical = poseMatrix(optical_from_mesh);
  program.setMatrix("optical_from_mesh", optical.data());
  program.setMatrix("clip_from_optical", clip_from_optical.data());
}

/// Sets the uniforms of shaders/draw/shading.glsl for the light of a camera.
inline void setLight(const gpu::Program& program, const CameraConfig& camera) {
  const float light[] = {static_cast<float>((camera.target_m - camera.position_m).norm()),
                         static_cast<float>(std::tan(camera.light_cone_deg * M_PI / 360))};
  program.set("lens_lights", camera.light == CameraLight::kLens ? 1 : 0);
  program.set("lens_light", light);
}

}  // namespace viscera
