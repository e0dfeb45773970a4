// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "math/processors.h"

#include <sched.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>
#include <thread>
#include <vector>

namespace viscera {

namespace {

constexpr int kMostProcessors = 1 << 16;  // largest set of processors that is tried

std::string textOf(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Returns the number of processors in the affinity mask; 0: unknown.
int processorsOfAffinity() {
  for (int most = CPU_SETSIZE; most <= kMostProcessors; most *= 2) {  // the kernel refuses sets smaller than its own
    std::vector<cpu_set_t> set(static_cast<size_t>(most / CPU_SETSIZE));
    const size_t bytes = set.size() * sizeof(cpu_set_t);
    if (sched_getaffinity(0, bytes, set.data()) == 0) return CPU_COUNT_S(bytes, set.data());
  }
  return 0;
}

/// Returns the quota of one group [processors], from the file of version 2, "MAX PERIOD", or the two files of version
/// 1. It is above 0, or nothing.
std::optional<double> quotaOf(const std::string& folder, bool unified) {
  double quota = 0, period = 0;
  if (unified) {
    std::istringstream(textOf(folder + "/cpu.max")) >> quota >> period;  // "max" does not parse as a number
  } else {
    std::istringstream(textOf(folder + "/cpu.cfs_quota_us")) >> quota;
    std::istringstream(textOf(folder + "/cpu.cfs_period_us")) >> period;
  }
  if (!(quota > 0 && period > 0)) return std::nullopt;
  return quota / period;
}

/// Returns whether these comma-separated controllers include `cpu`.
bool hasProcessors(const std::string& controllers) {
  return ("," + controllers + ",").find(",cpu,") != std::string::npos;
}

}  // namespace

std::optional<double> processorQuota(const std::string& mount, const std::string& groups) {
  std::optional<double> least;
  std::istringstream lines(groups);
  for (std::string line; std::getline(lines, line);) {  // number:controllers:path
    const size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = line.substr(first + 1, second - first - 1);
    const bool unified = controllers.empty();
    if (!unified && !hasProcessors(controllers)) continue;
    std::string path = line.substr(second + 1);
    if (path == "/") path.clear();
    for (;;) {  // the group and its parents; within a container, paths may be those of the host
      for (const char* in : {"", "/unified", "/cpu", "/cpu,cpuacct", "/cpuacct,cpu"}) {
        const std::optional<double> quota = quotaOf(mount + in + path, unified);
        if (quota) least = std::min(least.value_or(*quota), *quota);
      }
      if (path.empty()) break;
      path.erase(path.rfind('/'));
    }
  }
  return least;
}

int usableProcessors() {
  // Quotas are read once: loops query them in each round.
  static const std::optional<double> quota = processorQuota("/sys/fs/cgroup", textOf("/proc/self/cgroup"));
  int out = processorsOfAffinity();
  if (out == 0) out = static_cast<int>(std::thread::hardware_concurrency());
  if (quota) out = std::min(out, static_cast<int>(std::ceil(std::min<double>(*quota, kMostProcessors))));
  return std::max(1, out);
}

}  // namespace viscera
