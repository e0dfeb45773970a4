// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace viscera::nodes {

/// The folder in which services write and read files, `~saved_folder`. Any host on the network may call them, so they
/// accept plain file names only, and all files together are limited to `~saved_limit_gb`.
class SavedFolder {
 public:
  /// @param limit_gb  limit of all files in it [GB, 10^9 bytes]
  SavedFolder(const std::string& folder, double limit_gb);

  const std::string& path() const { return path_; }  ///< absolute path
  /// Returns the path of a file. @throws Error  the name is not a plain file name
  std::string pathOf(const std::string& file) const;
  /// Creates the folder. @return bytes that may still be written, > 0   @throws Error  it cannot be created, or is full
  uint64_t room() const;

 private:
  std::string path_;
  double limit_gb_;
};

}  // namespace viscera::nodes
