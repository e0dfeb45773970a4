// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdlib>
#include <string>

// Absolute paths, defined in a source that test/CMakeLists.txt writes for each test program.
extern const char* const kSourceFolder;
extern const char* const kCommand;       ///< the program `viscera`; empty: not built
extern const char* const kDicomProgram;  ///< the program `viscera-dicom`; empty: not built

namespace viscera::test {

/// Returns the folder with config/ and the sources that tests read: that in the environment variable
/// VISCERA_SOURCE_DIR, as in a bundle (scripts/bundle --tests), or the tree from which the test was built.
inline std::string sourceFolder() {
  const char* given = std::getenv("VISCERA_SOURCE_DIR");
  return given ? given : kSourceFolder;
}

}  // namespace viscera::test
