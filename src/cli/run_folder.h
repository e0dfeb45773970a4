// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "math/out_file.h"

namespace viscera::cli {

/// A requested output file of a command.
struct Output {
  std::string option, path;  ///< option and path; empty path: not requested
  FileKind kind;
};

/// Returns the files with fixed names in the folder of a run. @param folder  empty: none
std::vector<Output> outputsIn(const std::string& folder);

/// Checks all files that a command will write, before any computation.
/// @throws Error  two of them are one file, or one may not be written (requireReplaceable)
void requireOutputs(const std::vector<Output>& outputs);

/// The folder of `--out`. It lists what a run writes into it, so that the next run can remove these files. Files that
/// no run wrote, and saved states and recordings, stay.
class RunFolder {
 public:
  /// Creates the folder, removes the files of the previous run, and reports that. @param folder  empty: none is written
  /// @throws Error  it cannot be created, or a file in it cannot be removed
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
