// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

#include "gpu/gl.h"
#include "render/shapes/tool_shape.h"

namespace viscera {

/// Inputs of shaders/draw/mesh.vert.
enum MeshInput : GLuint { kPositionInput = 0, kNormalInput = 1, kColorInput = 2, kRestInput = 3 };

/// Formats of vertex inputs; the buffers themselves are bound when drawing.
class VertexArray {
 public:
  VertexArray() {
    glCreateVertexArrays(1, &id_);
    gpu::countObject();
  }
  ~VertexArray() { glDeleteVertexArrays(1, &id_); }
  VertexArray(const VertexArray&) = delete;
  VertexArray& operator=(const VertexArray&) = delete;

  /// Sets the format of an input: `size` components of `type`, `offset` bytes into each element of the buffer at
  /// `binding`.
  void describe(GLuint input, GLuint binding, GLint size, GLenum type, GLboolean normalized, GLuint offset) {
    glEnableVertexArrayAttrib(id_, input);
    glVertexArrayAttribFormat(id_, input, size, type, normalized, offset);
    glVertexArrayAttribBinding(id_, input, binding);
  }
  /// Sets the formats that mesh.vert reads of tools: vertices that are ToolVertex, and their indices.
  void readTools(GLuint vertices, GLuint indices) {
    constexpr GLuint kBinding = 0;
    describe(kPositionInput, kBinding, 3, GL_FLOAT, GL_FALSE, offsetof(ToolVertex, position_m));
    describe(kNormalInput, kBinding, 3, GL_FLOAT, GL_FALSE, offsetof(ToolVertex, normal));
    describe(kColorInput, kBinding, 4, GL_UNSIGNED_BYTE, GL_TRUE, offsetof(ToolVertex, color));
    glVertexArrayVertexBuffer(id_, kBinding, vertices, 0, sizeof(ToolVertex));
    glVertexArrayElementBuffer(id_, indices);
  }
  GLuint id() const { return id_; }

 private:
  GLuint id_ = 0;
};

}  // namespace viscera
