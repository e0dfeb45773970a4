// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gpu/gl.h"
#include "render/renderer.h"
#include "render/vertex_array.h"

namespace viscera {

/// Draws the triangles of a mesh, part by part. @param inputs  that is bound   @param before  (part) is called first
template <class Before>
void drawParts(const MeshView& mesh, const VertexArray& inputs, Before before) {
  const auto draw = [&](const DrawnPart& part) {
    before(part);
    glVertexArrayElementBuffer(inputs.id(), part.indices);
    if (part.fronts_only) glEnable(GL_CULL_FACE);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(part.count), GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(part.first * sizeof(uint32_t)));
    if (part.fronts_only) glDisable(GL_CULL_FACE);
  };
  if (!mesh.parts) return draw({mesh.indices, mesh.charts, 0, mesh.index_count, false});
  for (const DrawnPart& part : *mesh.parts) draw(part);
}

}  // namespace viscera
