// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// GLEW must come before any other OpenGL header.
#include <GL/glew.h>

#include <string>

namespace viscera::gpu {

/// "0x502 (GL_INVALID_OPERATION)" and the like.
std::string glErrorText(unsigned code);

/// From now on checkErrors() tells what the driver of the current context says of errors, where it says anything:
/// asynchronously, and of nothing but errors, so that it costs nothing while there are none.
void noteErrors();
/// @param status  of glGetGraphicsResetStatus()   @throws GpuError  it is lost; `what` names the work done
void requireNoReset(unsigned status, const char* what);

/// Counts an OpenGL object made; see objectsCreated().
void countObject();

}  // namespace viscera::gpu
