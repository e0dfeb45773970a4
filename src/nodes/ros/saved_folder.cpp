// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/ros/saved_folder.h"

#include <filesystem>

#include "math/number_text.h"
#include "viscera/math/error.h"

namespace viscera::nodes {
namespace {

namespace fs = std::filesystem;

constexpr double kBytesPerGb = 1e9;

double bytesIn(const std::string& folder) {
  double out = 0;
  std::error_code error;
  fs::recursive_directory_iterator at(folder, fs::directory_options::skip_permission_denied, error), end;
  for (; !error && at != end; at.increment(error)) {
    std::error_code gone;  // others may remove files concurrently
    if (!at->is_regular_file(gone) || gone) continue;
    const uintmax_t bytes = at->file_size(gone);
    if (!gone) out += static_cast<double>(bytes);
  }
  return out;
}

}  // namespace

SavedFolder::SavedFolder(const std::string& folder, double limit_gb)
    : path_(fs::absolute(folder).string()), limit_gb_(limit_gb) {}

std::string SavedFolder::pathOf(const std::string& file) const {
  if (file.empty() || file.front() == '.' || file.find('/') != std::string::npos)
    throw Error("file: '" + file + "' must be a plain file name in ~saved_folder, " + path_);
  return path_ + "/" + file;
}

uint64_t SavedFolder::room() const {
  std::error_code error;
  fs::create_directories(path_, error);
  if (error) throw Error("parameter ~saved_folder: " + path_ + " cannot be created: " + error.message());
  const double used = bytesIn(path_), left = limit_gb_ * kBytesPerGb - used;
  if (left >= 1) return static_cast<uint64_t>(left);
  throw Error("parameter ~saved_folder: " + path_ + " contains " + numberText(used / kBytesPerGb, 3) +
              " GB; services may fill at most " + numberText(limit_gb_, 3) +
              " GB. Remove files, or raise ~saved_limit_gb");
}

}  // namespace viscera::nodes
