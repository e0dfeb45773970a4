// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace viscera {

/// A file of src/export/page/viewer, embedded in the program.
struct EmbeddedViewerFile {
  const char* name;
  const char* text;
};
extern const EmbeddedViewerFile kEmbeddedViewerFiles[];  ///< scripts in the order in which they run
extern const int kEmbeddedViewerFileCount;

}  // namespace viscera
