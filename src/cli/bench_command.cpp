// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "cli/commands.h"
#include "viscera/math/error.h"

namespace viscera::cli {

int bench(char** arguments) {
  const std::filesystem::path program =
      std::filesystem::read_symlink("/proc/self/exe").replace_filename("viscera-bench");
  execv(program.c_str(), arguments);
  const std::string how = errno == ENOENT ? "; build the target viscera-bench" : "";
  throw Error(program.string() + " cannot be started: " + std::strerror(errno) + how);
}

}  // namespace viscera::cli
