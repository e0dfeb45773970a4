// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "viscera/math/error.h"

namespace viscera {

// Which files a process may read as scenes and meshes, and as what they refer to (images, materials, buffers). Any
// file, unless others choose the files, for example over a network.

/// Error for a file outside the allowed folders. It reveals neither the file's content nor whether it exists.
struct FileBoundError : Error {
  using Error::Error;
};

/// Restricts later reads to files within these folders, also through links. Must not be called during a read.
/// @param folders  absolute; none: any file   @param by  who set the restriction, for errors
/// @throws FileBoundError  not the absolute path of a folder
void bindFilesTo(const std::vector<std::string>& folders, const std::string& by);

/// Checks a file that is about to be read; no writer replaces it from then on (math/out_file.h).
/// @throws FileBoundError  before the file is opened or examined
void requireWithinBounds(const std::string& path);

}  // namespace viscera
