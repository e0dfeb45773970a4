// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "gpu/background.h"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

namespace viscera::gpu {

namespace {

constexpr int kNice = 10;                         // about a tenth of the processor next to a busy thread
constexpr const char* kRasteriser = "llvmpipe-";  // prefix of the names of its threads

void lowerPriority(id_t thread) {
  setpriority(PRIO_PROCESS, thread, std::max(kNice, getpriority(PRIO_PROCESS, thread)));
}

}  // namespace

void drawInBackground() {
  lowerPriority(static_cast<id_t>(syscall(SYS_gettid)));
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task", none)) {
    std::string name;
    std::getline(std::ifstream(entry.path() / "comm"), name);
    if (name.rfind(kRasteriser, 0) == 0)
      lowerPriority(static_cast<id_t>(std::strtoul(entry.path().filename().c_str(), nullptr, 10)));
  }
}

}  // namespace viscera::gpu
