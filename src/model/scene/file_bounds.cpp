// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scene/file_bounds.h"

#include <algorithm>
#include <filesystem>

#include "math/out_file.h"

namespace viscera {
namespace {

namespace fs = std::filesystem;

struct Bounds {
  std::vector<fs::path> folders;  ///< canonical paths, without links; empty: any file
  std::string by;
};

Bounds& bounds() {
  static Bounds of_process;
  return of_process;
}

bool isWithin(const fs::path& folder, const fs::path& file) {
  return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
}

}  // namespace

void bindFilesTo(const std::vector<std::string>& folders, const std::string& by) {
  Bounds next{{}, by};
  for (const std::string& folder : folders) {
    std::error_code error;
    const fs::path found = fs::canonical(folder, error);
    if (error || !fs::is_directory(found, error) || !fs::path(folder).is_absolute())
      throw FileBoundError(by + ": '" + folder + "' must be the absolute path of an existing folder");
    next.folders.push_back(found);
  }
  bounds() = std::move(next);
}

void requireWithinBounds(const std::string& path) {
  const Bounds& now = bounds();
  if (now.folders.empty()) return recordRead(path);
  std::error_code error;
  const fs::path file = fs::weakly_canonical(fs::absolute(path), error);
  const auto holds = [&](const fs::path& folder) { return isWithin(folder, file); };
  if (!error && std::any_of(now.folders.begin(), now.folders.end(), holds)) return recordRead(path);
  std::string text = path + ": is, with links resolved, outside the folders of " + now.by + ":";
  for (const fs::path& folder : now.folders) text += " " + folder.string();
  throw FileBoundError(text);
}

}  // namespace viscera
