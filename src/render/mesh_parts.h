// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "gpu/gl.h"
#include "render/renderer.h"
#include "render/vertex_array.h"

namespace viscera {

/// Draws the triangles of a mesh, run by run. @param inputs  must be bound   @param before  called with the run first
template <class Before>
void drawParts(const MeshView& mesh, const VertexArray& inputs, Before before) {
  glVertexArrayElementBuffer(inputs.id(), mesh.indices);
  const auto draw = [&](const IndexRun& run) {
    before(run);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(run.count), GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(run.first * sizeof(uint32_t)));
  };
  if (!mesh.runs) return draw({0, mesh.index_count});
  for (const IndexRun& run : *mesh.runs) draw(run);
}

}  // namespace viscera
