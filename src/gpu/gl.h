// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// GLEW must come before any other OpenGL header.
#include <GL/glew.h>

#include <string>

namespace viscera::gpu {

/// "0x502 (GL_INVALID_OPERATION)" and the like.
std::string glErrorText(unsigned code);

/// Counts an OpenGL object made; see objectsCreated().
void countObject();

}  // namespace viscera::gpu
