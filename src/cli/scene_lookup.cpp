// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/scene_lookup.h"

#include <unistd.h>

#include <iostream>

#include "math/nearest_names.h"
#include "math/shipped_files.h"
#include "viscera/math/error.h"

/// The config/ folder of the source tree from which this program was built.
extern const char* const kSourceConfig;

namespace viscera::cli {

namespace {

/// Returns the end of an error message: names that may have been meant.
std::string shippedOnes(const std::string& name, const std::string& kind) {
  const std::vector<std::string> names = shippedNames(kind, kSourceConfig);
  return names.empty() ? "" : "; shipped: " + nearestFirstText(name, names);
}

}  // namespace

std::string findScene(const std::string& name) {
  const std::string file = shippedFile(name, "scenes", kSourceConfig);
  if (file.empty())
    throw SceneError("'" + name + "' is neither a file nor the name of a shipped scene" + shippedOnes(name, "scenes"));
  return file;
}

std::string findTask(const std::string& name) {
  const std::string file = shippedFile(name, "tasks", kSourceConfig);
  if (file.empty())
    throw Error("'" + name + "' is neither a file nor the name of a shipped task" + shippedOnes(name, "tasks"));
  return file;
}

FittedScene sceneOf(const RunOptions& options) {
  return loadFittedScene(findScene(options.scene), meshOverrides(options.mesh), options.overrides);
}

Progress consoleProgress() {
  const bool terminal = isatty(STDERR_FILENO) != 0;
  return [terminal, stage = std::string(), shown = -1](const std::string& name, double fraction) mutable {
    const int step = static_cast<int>(fraction * (terminal ? 100 : 4));
    if (name == stage && step <= shown) return;
    if (terminal) {
      std::cerr << (name == stage || stage.empty() ? "\r" : "\n") << name << " " << step << " %" << std::flush;
      if (step >= 100) std::cerr << "\r" << name << " done \n";
    } else {
      std::cerr << name << " " << static_cast<int>(fraction * 100) << " %\n";
    }
    stage = terminal && step >= 100 ? "" : name;
    shown = step;
  };
}

}  // namespace viscera::cli
