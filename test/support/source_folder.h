// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdlib>
#include <string>

namespace viscera::test {

/// Where config/ and the sources are that tests read: the environment's VISCERA_SOURCE_DIR, as of a bundle
/// (scripts/bundle --tests), or the tree that the test was built from.
inline std::string sourceFolder() {
  const char* given = std::getenv("VISCERA_SOURCE_DIR");
  return given ? given : VISCERA_SOURCE_DIR;
}

}  // namespace viscera::test
