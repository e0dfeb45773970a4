// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "render/tissue_painter.h"

#include "render/mesh_uniforms.h"

namespace viscera {

TissuePainter::TissuePainter() : program_(gpu::Program::graphics("mesh.vert", "tissue.frag")) {
  inputs_.describe(kPositionInput, kPositionInput, 3, GL_FLOAT, GL_FALSE, 0);
  inputs_.describe(kNormalInput, kNormalInput, 4, GL_INT_2_10_10_10_REV, GL_TRUE, 0);
  inputs_.describe(kColorInput, kColorInput, 4, GL_UNSIGNED_BYTE, GL_TRUE, 0);
}

void TissuePainter::draw(const MeshView& mesh, const ToolShadows& shadows, const Pose& optical_from_tissue,
                         const Eigen::Matrix4f& clip_from_optical) {
  glMemoryBarrier(GL_VERTEX_ATTRIB_ARRAY_BARRIER_BIT | GL_ELEMENT_ARRAY_BARRIER_BIT);  // kernels wrote these buffers
  glVertexArrayVertexBuffer(inputs_.id(), kPositionInput, mesh.positions, 0, 3 * sizeof(float));
  glVertexArrayVertexBuffer(inputs_.id(), kNormalInput, mesh.normals, 0, sizeof(uint32_t));
  glVertexArrayVertexBuffer(inputs_.id(), kColorInput, mesh.colors, 0, sizeof(uint32_t));
  glVertexArrayElementBuffer(inputs_.id(), mesh.indices);
  glBindVertexArray(inputs_.id());
  program_.use();
  setMeshMatrices(program_, optical_from_tissue, clip_from_optical);
  program_.set("shafts", shadows.count);
  if (shadows.count > 0) {
    const auto count = static_cast<size_t>(shadows.count);
    program_.setVectors("shaft_tips", shadows.tips[0].data(), 4, count);
    program_.setVectors("shaft_ends", shadows.ends[0].data(), 4, count);
  }
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(mesh.index_count), GL_UNSIGNED_INT, nullptr);
  glBindVertexArray(0);
}

}  // namespace viscera
