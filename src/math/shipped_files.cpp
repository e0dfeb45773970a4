// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "math/shipped_files.h"

#include <dlfcn.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <vector>

namespace viscera {

namespace fs = std::filesystem;

namespace {

/// Adds folders config/ that may exist: of the installation with `binary`, and of the sources of the build that
/// contains it.
void addFolders(const fs::path& binary, std::vector<fs::path>& out) {
  for (fs::path up = binary.parent_path(); !up.empty(); up = up.parent_path()) {
    const fs::path share = up / "share" / "viscera";
    out.push_back(share / "config");
    std::string sources;  // cmake/library.cmake
    if (std::getline(std::ifstream(share / "config_folder.txt"), sources)) out.emplace_back(sources);
    if (up == up.parent_path()) return;
  }
}

/// Returns folders in the order of the search. @param last  another one, or nothing
std::vector<fs::path> configFolders(const std::string& last) {
  std::vector<fs::path> out;
  std::error_code error;
  addFolders(fs::read_symlink("/proc/self/exe", error), out);
  Dl_info here{};
  if (dladdr(reinterpret_cast<const void*>(&configFolders), &here) != 0 && here.dli_fname) {
    addFolders(fs::absolute(here.dli_fname, error), out);
    // The loader may have found it in /lib, which is a link to /usr/lib.
    addFolders(fs::canonical(here.dli_fname, error), out);
  }
  if (!last.empty()) out.emplace_back(last);
  return out;
}

}  // namespace

std::string shippedFile(const std::string& name, const std::string& kind, const std::string& last) {
  std::error_code error;
  if (fs::exists(name, error) || name.find('/') != std::string::npos) return name;
  for (const fs::path& folder : configFolders(last)) {
    const fs::path file = folder / kind / (name + ".yaml");
    if (fs::exists(file, error)) return file.string();
  }
  return "";
}

std::vector<std::string> shippedNames(const std::string& kind, const std::string& last) {
  std::vector<std::string> out;
  for (const fs::path& folder : configFolders(last)) {
    std::error_code error;
    for (const auto& file : fs::directory_iterator(folder / kind, error)) {
      if (file.path().extension() == ".yaml") out.push_back(file.path().stem().string());
    }
    if (!out.empty()) break;
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace viscera
