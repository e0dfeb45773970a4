// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scene/host_memory.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include "math/number_text.h"
#include "model/scene/integrators.h"
#include "viscera/math/error.h"
#include "viscera/model/scene/scene.h"

namespace viscera {
namespace {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// Returns the number in a file; unlimited where there is none, as in "max".
double numberIn(const std::string& path) {
  std::ifstream file(path);
  std::string text;
  return file >> text ? readNumber(text).value_or(kUnlimited) : kUnlimited;
}

/// Returns the number after a word at the start of a line; `otherwise` where there is none.
double numberBehind(const std::string& path, const std::string& word, double otherwise) {
  std::ifstream file(path);
  std::string line, key;
  while (std::getline(file, line)) {
    TextIn words(line);
    double value = 0;
    if (words >> key >> value && key == word) return value;
  }
  return otherwise;
}

/// Returns what a group may still allocate [bytes]. Inactive file pages are reclaimed when memory is short.
double leftOf(const std::string& folder, const char* limit, const char* usage, const char* idle) {
  const double most = numberIn(folder + "/" + limit), used = numberIn(folder + "/" + usage);
  if (most == kUnlimited || used == kUnlimited) return kUnlimited;
  return std::max(0.0, most - std::max(0.0, used - numberBehind(folder + "/memory.stat", idle, 0)));
}

/// Returns the smallest amount that a group and its ancestors leave. @param path  as in /proc/self/cgroup, such as
/// /user/session
template <class Left>
double leastUpwards(std::string path, Left left) {
  double least = left("");
  for (; path.size() > 1; path.resize(path.rfind('/'))) least = std::min(least, left(path));
  return least;
}

double leftByGroups(const std::string& root) {
  const std::string mount = root + "/sys/fs/cgroup";
  std::ifstream groups(root + "/proc/self/cgroup");
  std::string line;
  double least = kUnlimited;
  while (std::getline(groups, line)) {  // number:controllers:path
    const size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",",
                      path = line.substr(second + 1);
    if (controllers == ",,") {
      least = std::min(least, leastUpwards(path, [&](const std::string& at) {
                         return leftOf(mount + at, "memory.max", "memory.current", "inactive_file");
                       }));
    } else if (controllers.find(",memory,") != std::string::npos) {
      least = std::min(least, leastUpwards(path, [&](const std::string& at) {
                         return leftOf(mount + "/memory" + at, "memory.limit_in_bytes", "memory.usage_in_bytes",
                                       "total_inactive_file");
                       }));
    }
  }
  return least;
}

}  // namespace

double availableBytes(const std::string& root) {
  const double kibibytes = numberBehind(root + "/proc/meminfo", "MemAvailable:", kUnlimited);
  return std::min(1024 * kibibytes, leftByGroups(root));
}

double bytesPerFilledCell(const Scene& scene) {
  if (!scene.collision.enabled) return kBytesPerFilledCell;
  const bool solved = !traitsOf(scene.solver.integrator).is_explicit;
  return kBytesPerFilledCell + (solved ? kBytesPerCellOfSolvedContacts : kBytesPerCellOfContacts);
}

void requireTissueMemory(size_t filled_cells, double spacing_m, double bytes_per_cell, double available_bytes) {
  constexpr double kGiB = 1 << 30, kMargin = 1.05;
  const double needed = bytes_per_cell * static_cast<double>(filled_cells);
  if (needed <= available_bytes) return;
  TextOut out;
  out << "spacing_m " << spacing_m << " fills " << filled_cells << " cells, which need about " << needed / kGiB
      << " GiB of memory to be simulated and drawn, but this process can have " << available_bytes / kGiB
      << " GiB; spacing_m >= " << spacing_m * kMargin * std::cbrt(needed / available_bytes) << " would fit";
  throw LatticeError(out.str());
}

}  // namespace viscera
