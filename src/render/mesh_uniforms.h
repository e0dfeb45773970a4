// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

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

}  // namespace viscera
