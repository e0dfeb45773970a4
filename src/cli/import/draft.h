// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <string>

#include "viscera/math/error.h"

namespace viscera::cli {

/// A folder beside the one that is asked for, which it becomes, or else goes away with all that is in it.
class Draft {
 public:
  explicit Draft(const std::string& out) : out_(std::filesystem::absolute(out).lexically_normal()) {
    if (!out_.has_filename()) out_ = out_.parent_path();
    std::error_code error;
    if (std::filesystem::exists(out_, error) &&
        !(std::filesystem::is_directory(out_, error) && std::filesystem::is_empty(out_, error)))
      throw Error(out + ": is there already; accepted by --out: a new or an empty folder");
    draft_ = out_.string() + ".part-XXXXXX";
    if (!mkdtemp(draft_.data()))
      throw Error(out + ": cannot be written; accepted by --out: a folder within one that is there");
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
