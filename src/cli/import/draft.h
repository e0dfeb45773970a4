// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <string>

#include "viscera/math/error.h"

namespace viscera::cli {

/// Temporary folder next to the requested one. It is renamed to the requested one at the end, or removed with its
/// contents.
class Draft {
 public:
  explicit Draft(const std::string& out) : out_(std::filesystem::absolute(out).lexically_normal()) {
    if (!out_.has_filename()) out_ = out_.parent_path();
    std::error_code error;
    if (std::filesystem::exists(out_, error) &&
        !(std::filesystem::is_directory(out_, error) && std::filesystem::is_empty(out_, error)))
      throw Error(out + ": already exists; --out must be a new or an empty folder");
    draft_ = out_.string() + ".part-XXXXXX";
    if (!mkdtemp(draft_.data()))
      throw Error(out + ": cannot be written; the parent folder of --out must exist and be writable");
    std::filesystem::permissions(draft_, std::filesystem::perms(0755), error);
  }
  ~Draft() {
    std::error_code error;
    if (!draft_.empty()) std::filesystem::remove_all(draft_, error);
  }
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;

  std::filesystem::path file(const std::string& name) const { return std::filesystem::path(draft_) / name; }
  void keep() {
    std::error_code error;
    std::filesystem::rename(draft_, out_, error);
    if (error) throw Error(out_.string() + ": cannot be written: " + error.message());
    draft_.clear();
  }

 private:
  std::filesystem::path out_;
  std::string draft_;
};

}  // namespace viscera::cli
