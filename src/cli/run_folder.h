// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "math/out_file.h"

namespace viscera::cli {

/// File that a command was asked to write.
struct Output {
  std::string option, path;  ///< path empty: it was not asked for
  FileKind kind;
};

/// Returns the files of fixed names in the folder of a run. @param folder  empty: none
std::vector<Output> outputsIn(const std::string& folder);

/// Checks all files that a command will write, before it computes anything for them.
/// @throws Error  two of them are one file, or one may not be written (requireReplaceable)
void requireOutputs(const std::vector<Output>& outputs);

/// Folder of `--out`, which lists what a run writes into it, so that the next one can take all of that away. Files that
/// no run wrote, and saved states and recordings, stay.
class RunFolder {
 public:
  /// Makes the folder, removes the files of the run before, and says so. @param folder  empty: none is written
  /// @throws Error  it cannot be made, or a file in it cannot be removed
  explicit RunFolder(const std::string& folder);
  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

 private:
  void clear() const;
  void list(const std::string& path, FileKind kind);

  std::string folder_;
  std::set<std::string> listed_;
};

}  // namespace viscera::cli
