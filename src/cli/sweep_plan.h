// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace viscera::cli {

/// Scene keys and the values that they take, as --set has them.
using KeyValues = std::vector<std::pair<std::string, std::string>>;

/// Sessions that differ in values of their scene, as a file lists them (docs/cluster.md).
struct SweepPlan {
  std::string scene, mesh, strokes;  ///< mesh and strokes may be empty
  std::string seconds;               ///< empty: the strokes' length, or 1
  bool view = false;                 ///< with OpenGL, where the scene has a use for it
  bool keep = false;                 ///< pictures, metrics.json and surface.ply of every run
  KeyValues set;                     ///< of every run
  std::vector<std::string> varied;   ///< keys that differ from run to run, in the order of the file
  std::vector<KeyValues> runs;       ///< [runs] what each has of these
  std::map<std::string, int> lines;  ///< of the file, of each key of the scene that it names

  bool sets(const std::string& key) const;               ///< in every run, or in some
  std::vector<std::string> arguments(size_t run) const;  ///< of `viscera`
  std::string text() const;                              ///< that two plans share only if their runs are the same
};

/// @throws SceneError  file, line, key and what is accepted; of keys of the scene, those that it has no place for.
/// Values are left to the runs
SweepPlan readSweepPlan(const std::string& file);

}  // namespace viscera::cli
