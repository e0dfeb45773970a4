// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/scene_lookup.h"

#include <unistd.h>

#include <filesystem>
#include <iostream>

#include "viscera/math/error.h"

/// config/ of the source tree that this program was built from.
extern const char* const kSourceConfig;

namespace viscera::cli {

namespace fs = std::filesystem;

namespace {

/// Folders of what is shipped of a kind: beside an installed program, then in the source tree it was built from.
std::vector<fs::path> shippedFolders(const std::string& kind) {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  std::vector<fs::path> out;
  if (!error) {
    for (fs::path up = program.parent_path(); up != up.parent_path(); up = up.parent_path()) {
      out.push_back(up / "share" / "viscera" / "config" / kind);
    }
  }
  out.push_back(fs::path(kSourceConfig) / kind);
  return out;
}

/// The file itself, or the shipped one of that name; empty: neither.
std::string findShipped(const std::string& name, const std::string& kind) {
  std::error_code error;
  if (fs::exists(name, error) || name.find('/') != std::string::npos) return name;
  for (const fs::path& folder : shippedFolders(kind)) {
    const fs::path file = folder / (name + ".yaml");
    if (fs::exists(file, error)) return file.string();
  }
  return "";
}

}  // namespace

std::string findScene(const std::string& name) {
  const std::string file = findShipped(name, "scenes");
  if (file.empty()) throw SceneError("'" + name + "' is neither a file nor the name of a shipped scene");
  return file;
}

std::string findTask(const std::string& name) {
  const std::string file = findShipped(name, "tasks");
  if (file.empty()) throw Error("'" + name + "' is neither a file nor the name of a shipped task");
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
