// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "render/tool_painter.h"

#include <algorithm>

#include "render/mesh_uniforms.h"
#include "viscera/layout/picture_labels.h"

namespace viscera {

ToolPainter::ToolPainter(const std::vector<StylusConfig>& styluses, const std::vector<std::string>& features)
    : styluses_(styluses), program_(gpu::Program::graphics("mesh.vert", "tool.frag", features)) {
  std::vector<ToolVertex> vertices;
  std::vector<uint32_t> indices;
  for (const StylusConfig& stylus : styluses) {
    ranges_.emplace_back();
    for (const ToolKind& kind : kToolKinds) {
      const ToolShape shape = toolWithoutFingers(stylus, kind.mode), finger = fingerShape(stylus, kind.mode);
      ranges_.back()[kind.number] = {indices.size(), shape.solid_indices, shape.indices.size() - shape.solid_indices,
                                     finger.indices.size()};
      for (const ToolShape* part : {&shape, &finger}) {
        const uint32_t first_vertex = static_cast<uint32_t>(vertices.size());
        for (uint32_t index : part->indices) indices.push_back(first_vertex + index);
        vertices.insert(vertices.end(), part->vertices.begin(), part->vertices.end());
      }
    }
  }
  vertices_ = gpu::Buffer<ToolVertex>(vertices);
  indices_ = gpu::Buffer<uint32_t>(indices);
  inputs_.readTools(vertices_.id(), indices_.id());
}

bool ToolPainter::showsAny(const ToolMotions& motions) const {
  const size_t count = std::min(motions.size(), ranges_.size());
  return std::any_of(motions.begin(), motions.begin() + static_cast<std::ptrdiff_t>(count),
                     [](const StylusMotion& motion) { return motion.present; });
}

/// Draws a part of all styluses. @param before  called with the stylus first
template <class Before>
void ToolPainter::drawPart(const gpu::Program& program, Part part, const ToolMotions& motions,
                           const Pose& optical_from_tissue, const Eigen::Matrix4f& clip_from_optical, Before before) {
  for (size_t stylus = 0; stylus < std::min(motions.size(), ranges_.size()); ++stylus) {
    const StylusMotion& motion = motions[stylus];
    const Range& range = ranges_[stylus][kindOf(motion.mode).number];
    const bool solid = part == Part::kSolid;
    const size_t count = solid ? range.solid_indices : range.translucent_indices;
    if (!motion.present || count == 0) continue;
    before(stylus);
    const auto drawRange = [&](const Pose& pose, size_t first, size_t indices) {
      setMeshMatrices(program, optical_from_tissue * pose, clip_from_optical);
      glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(indices), GL_UNSIGNED_INT,
                     reinterpret_cast<const void*>(first * sizeof(uint32_t)));
    };
    drawRange(motion.to, range.first_index + (solid ? 0 : range.solid_indices), count);
    if (!solid || range.finger_indices == 0) continue;
    for (const Pose& finger : fingerPoses(styluses_[stylus], motion.mode, motion.opens_to_rad))
      drawRange(motion.to * finger, range.first_index + range.solid_indices + range.translucent_indices,
                range.finger_indices);
  }
}

void ToolPainter::draw(const ToolMotions& motions, const Pose& optical_from_tissue,
                       const Eigen::Matrix4f& clip_from_optical) {
  glBindVertexArray(inputs_.id());
  program_.use();
  drawPart(program_, Part::kSolid, motions, optical_from_tissue, clip_from_optical, [](size_t) {});
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glBlendEquation(GL_FUNC_ADD);
  glDepthMask(GL_FALSE);  // an outline hides nothing
  glEnable(GL_CULL_FACE);
  glCullFace(GL_BACK);
  drawPart(program_, Part::kTranslucent, motions, optical_from_tissue, clip_from_optical, [](size_t) {});
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
  glDisable(GL_CULL_FACE);
  glBindVertexArray(0);
}

void ToolPainter::drawGeometry(const gpu::Program& program, const ToolMotions& motions, const Pose& optical_from_tissue,
                               const Eigen::Matrix4f& clip_from_optical) {
  glBindVertexArray(inputs_.id());
  program.use();
  drawPart(program, Part::kSolid, motions, optical_from_tissue, clip_from_optical,
           [&](size_t stylus) { program.set("label", static_cast<uint32_t>(layout::kFirstToolLabel + stylus)); });
  glBindVertexArray(0);
}

}  // namespace viscera
