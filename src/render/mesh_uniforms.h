// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gpu/gl.h"
#include "viscera/gpu/program.h"
#include "viscera/render/camera.h"

namespace viscera {

/// Sets the uniforms of shaders/draw/mesh.vert.
inline void setMeshMatrices(const gpu::Program& program, const Pose& optical_from_mesh,
                            const Eigen::Matrix4f& clip_from_optical) {
  constexpr GLint kOpticalFromMesh = 0, kClipFromOptical = 1;  // locations in mesh.vert
  const Eigen::Matrix4f optical = poseMatrix(optical_from_mesh);
  glProgramUniformMatrix4fv(program.id(), kOpticalFromMesh, 1, GL_FALSE, optical.data());
  glProgramUniformMatrix4fv(program.id(), kClipFromOptical, 1, GL_FALSE, clip_from_optical.data());
}

}  // namespace viscera
