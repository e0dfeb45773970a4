// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

namespace viscera::nodes {

/// Folder that services write files into and read them from, `~saved_folder`. Callers may be anyone on the network:
/// they choose plain names alone, and together fill no more than `~saved_limit_gb`.
class SavedFolder {
 public:
  /// @param limit_gb  of all files in it, 10^9 bytes each
  SavedFolder(const std::string& folder, double limit_gb);

  const std::string& path() const { return path_; }  ///< absolute
  /// Returns the path of a file. @throws Error  no plain name
  std::string pathOf(const std::string& file) const;
  /// Makes the folder. @return bytes that may be written yet, > 0   @throws Error  it cannot be made, or is full
  uint64_t room() const;

 private:
  std::string path_;
  double limit_gb_;
};

}  // namespace viscera::nodes
