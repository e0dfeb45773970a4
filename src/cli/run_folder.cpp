// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/run_folder.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "viscera/math/error.h"

namespace viscera::cli {

namespace {

namespace fs = std::filesystem;

constexpr const char* kListName = "/.viscera_run";
constexpr const char* kListHead = "# files of the last run into this folder; the next run removes them";

/// Returns the canonical path of a file; of one that does not exist, its future path.
fs::path resolvedPath(const std::string& path) {
  std::error_code error;
  const fs::path resolved = fs::weakly_canonical(fs::absolute(path, error), error);
  return error ? fs::path(path).lexically_normal() : resolved;
}

/// Returns whether a listed name is within the folder. @param name  name from a list
bool isWithin(const std::string& name) {
  const fs::path path(name);
  return !name.empty() && path.is_relative() &&
         std::none_of(path.begin(), path.end(), [](const fs::path& step) { return step == ".."; });
}

}  // namespace

std::vector<Output> outputsIn(const std::string& folder) {
  if (folder.empty()) return {};
  return {{"--out", folder + "/metrics.json", FileKind::kJson},
          {"--out", folder + "/tools.csv", FileKind::kText},
          {"--out", folder + "/kinematics.txt", FileKind::kText},
          {"--out", folder + "/surface.ply", FileKind::kPly}};
}

void requireOutputs(const std::vector<Output>& outputs) {
  for (size_t i = 0; i < outputs.size(); ++i) {
    if (outputs[i].path.empty()) continue;
    requireReplaceable(outputs[i].path, outputs[i].kind);
    for (size_t j = 0; j < i; ++j) {
      if (outputs[j].path.empty() || resolvedPath(outputs[j].path) != resolvedPath(outputs[i].path)) continue;
      throw Error(outputs[j].option + " and " + outputs[i].option + " both write " + outputs[i].path +
                  "; give each its own file");
    }
  }
}

RunFolder::RunFolder(const std::string& folder) : folder_(folder) {
  if (folder_.empty()) return;
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) throw Error(folder_ + ": cannot create this folder for pictures: " + error.message());
  clear();
  std::ofstream file(folder_ + kListName, std::ios::trunc);
  file << kListHead << '\n';
  file.close();
  if (!file) throw Error(folder_ + kListName + ": cannot be written: " + std::strerror(errno));
  setWriteListener([this](const std::string& path, FileKind kind) { list(path, kind); });
}

RunFolder::~RunFolder() {
  if (!folder_.empty()) setWriteListener({});
}

void RunFolder::clear() const {
  std::ifstream file(folder_ + kListName);
  std::string line;
  if (!std::getline(file, line)) return;
  if (line != kListHead)
    throw Error(folder_ + kListName + ": is not a list of the files of a run; choose another --out");
  size_t removed = 0;
  std::set<fs::path> folders;
  while (std::getline(file, line)) {
    const fs::path path = fs::path(folder_) / line;
    std::error_code error;
    if (!isWithin(line) || !fs::is_regular_file(fs::symlink_status(path, error)) || isRead(path.string())) continue;
    if (!fs::remove(path, error))
      throw Error(path.string() + ": belongs to an older run and cannot be removed: " + error.message());
    ++removed;
    for (fs::path up = fs::path(line).parent_path(); !up.empty(); up = up.parent_path()) folders.insert(up);
  }
  for (auto folder = folders.rbegin(); folder != folders.rend(); ++folder) {  // nested folders first
    std::error_code error;
    fs::remove(fs::path(folder_) / *folder, error);  // fails if it is not empty
  }
  if (removed > 0)
    std::cout << folder_ << ": replaces an older run; removed " << removed << (removed == 1 ? " file" : " files")
              << " of it\n";
}

void RunFolder::list(const std::string& path, FileKind kind) {
  if (kind == FileKind::kState) return;
  const std::string name = fs::path(path).lexically_relative(folder_).generic_string();
  if (!isWithin(name) || !listed_.insert(name).second) return;
  std::ofstream file(folder_ + kListName, std::ios::app);
  file << name << '\n';
  file.close();
  if (!file) throw Error(folder_ + kListName + ": cannot be written: " + std::strerror(errno));
}

}  // namespace viscera::cli
