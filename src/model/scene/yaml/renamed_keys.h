// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace viscera {

/// Returns a path of keys with the names of this version. A path that needs no change comes back as it is.
/// @param path  path in a scene, strokes or task file, with or without indices, as in bodies[0].wetness
std::string withNewNames(const std::string& path);

/// Text of a file with its keys renamed.
struct UpgradedText {
  std::string text;
  std::vector<std::string> renamed;  ///< "old -> new" of each key, with paths, in the order of the file
};
/// Renames the keys of a YAML text to those of this version. Comments and layout stay as they are.
/// @throws YAML::Exception  the text is no YAML
UpgradedText upgradedText(const std::string& text);

}  // namespace viscera
