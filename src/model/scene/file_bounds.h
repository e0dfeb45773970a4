// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "viscera/math/error.h"

namespace viscera {

// Which files a process reads as scenes and meshes, and as what these name (pictures, materials, buffers): any, unless
// others choose them, as over a network.

/// A file lies where none may be read. Says nothing of what is in it, nor whether it is there.
struct FileBoundError : Error {
  using Error::Error;
};

/// From now on only files within these folders are read, wherever links lead. Not while others read some.
/// @param folders  absolute; none: any file   @param by  who says so, for errors
/// @throws FileBoundError  not the absolute path of a folder
void bindFilesTo(const std::vector<std::string>& folders, const std::string& by);

/// Checks a file that is about to be read, which no writer replaces from then on (math/out_file.h).
/// @throws FileBoundError  before anything of the file is looked at
void requireWithinBounds(const std::string& path);

}  // namespace viscera
