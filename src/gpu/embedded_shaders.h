// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace viscera::gpu {

/// A shader, or a header that is also GLSL, embedded in the program. Its name has no folder.
struct EmbeddedShader {
  const char* name;
  const char* text;
};
extern const EmbeddedShader kEmbeddedShaders[];
extern const int kEmbeddedShaderCount;

}  // namespace viscera::gpu
