// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>
#include <string>

namespace viscera {

/// Something in the world is wrong (a file, a key, a device): the message names it and what would do.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};
/// A scene file: unknown key, wrong type, value out of range. Names file, line, key and the accepted range.
struct SceneError : Error {
  using Error::Error;
};
/// A mesh file: missing, corrupt, empty, without volume. Names the file.
struct MeshError : Error {
  using Error::Error;
};
/// A lattice that cannot be built: spacing too large or too small for the memory there is.
struct LatticeError : Error {
  using Error::Error;
};
/// EGL or OpenGL: no usable device, or a call that failed. Names the call and the code.
struct GpuError : Error {
  using Error::Error;
};
/// A recorded strokes file. Names file and line.
struct StrokesError : Error {
  using Error::Error;
};

}  // namespace viscera
