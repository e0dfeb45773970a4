// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// GLEW must come before any other OpenGL header.
#include <GL/glew.h>

#include <string>

namespace viscera::gpu {

/// Returns an error as text, such as "0x502 (GL_INVALID_OPERATION)".
std::string glErrorText(unsigned code);

/// Makes checkErrors() include messages of the current context's driver. The driver reports them asynchronously, and
/// only errors, so it costs nothing while there are none.
void recordErrors();
/// Checks that the GPU was not reset. @param status  of glGetGraphicsResetStatus()   @throws GpuError  it was; `what`
/// names the work done
void requireNoReset(unsigned status, const char* what);

/// Counts a new OpenGL object; see objectsCreated().
void countObject();

}  // namespace viscera::gpu
