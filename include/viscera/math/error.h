// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

#include "viscera/api.h"

namespace VISCERA_PUBLIC viscera {

/// Error in the input or the environment (a file, a key, a device). The message names it and says how to fix it.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};
/// Error in a scene file: unknown key, wrong type, value out of range. Names file, line, key and the accepted range.
struct SceneError : Error {
  using Error::Error;
};
/// Error in a mesh file: missing, corrupt, empty, without volume. Names the file.
struct MeshError : Error {
  using Error::Error;
};
/// Error for a lattice that cannot be built: the spacing is too large, or too small for the available memory.
struct LatticeError : Error {
  using Error::Error;
};
/// Error of EGL or OpenGL: no usable device, or a call that failed. Names the call and the code.
struct GpuError : Error {
  using Error::Error;
};
/// Error in a recorded strokes file. Names file and line.
struct StrokesError : Error {
  using Error::Error;
};

}  // namespace viscera
