// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace viscera::cli {

/// Scene keys and their values, in the syntax of --set.
using KeyValues = std::vector<std::pair<std::string, std::string>>;

/// Sessions that differ in values of their scene, as listed in a file (docs/cluster.md).
struct SweepPlan {
  std::string scene, mesh, strokes;  ///< files; mesh and strokes may be empty
  std::string seconds;               ///< duration; empty: the strokes' length, or 1
  bool view = false;                 ///< whether to use OpenGL if the scene needs it
  bool keep = false;                 ///< whether to keep images, metrics.json and surface.ply of every run
  KeyValues set;                     ///< values of every run
  std::vector<std::string> varied;   ///< keys that differ between runs, in the order of the file
  std::vector<KeyValues> runs;       ///< [runs] values of these keys
  std::map<std::string, int> lines;  ///< line in the file of each scene key

  bool sets(const std::string& key) const;               ///< whether any run sets the key
  std::vector<std::string> arguments(size_t run) const;  ///< arguments of `viscera`
  std::string text() const;                              ///< text that is equal only for plans with equal runs
};

/// Reads a plan. Values are checked by the runs.
/// @throws SceneError  names file, line, key and what is accepted; also for keys that the scene does not have
SweepPlan readSweepPlan(const std::string& file);

}  // namespace viscera::cli
