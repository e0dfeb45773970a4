// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <vector>

#include "viscera/calibration/step_time.h"

namespace viscera {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMostEntries = 64;  ///< older ones are forgotten

struct Entry {
  std::string key;
  StepTime time;
};

bool makesSense(const StepTime& time) {
  return std::isfinite(time.overhead_s) && std::isfinite(time.per_node_s) && time.overhead_s >= 0 &&
         time.per_node_s > 0;
}

std::optional<Entry> parse(const std::string& line) {
  const size_t tab = line.find('\t');
  if (tab == std::string::npos || tab == 0) return std::nullopt;
  Entry entry{line.substr(0, tab), {}};
  std::istringstream numbers(line.substr(tab));
  std::string rest;
  if (!(numbers >> entry.time.overhead_s >> entry.time.per_node_s) || numbers >> rest) return std::nullopt;
  if (!makesSense(entry.time)) return std::nullopt;
  return entry;
}

std::vector<Entry> readEntries(const std::string& path) {
  std::vector<Entry> entries;
  std::ifstream file(path);
  for (std::string line; entries.size() < kMostEntries && std::getline(file, line);) {
    if (std::optional<Entry> entry = parse(line)) entries.push_back(*entry);
  }
  return entries;
}

std::string absoluteVariable(const char* name) {
  const char* value = std::getenv(name);
  return value && value[0] == '/' ? value : "";  // the XDG specification ignores relative ones
}

}  // namespace

StepTimeCache::StepTimeCache(const std::string& folder) : file_(folder.empty() ? "" : folder + "/step_times.tsv") {}

StepTimeCache StepTimeCache::ofUser() {
  const std::string cache = absoluteVariable("XDG_CACHE_HOME"), home = absoluteVariable("HOME");
  if (!cache.empty()) return StepTimeCache(cache + "/viscera");
  return StepTimeCache(home.empty() ? "" : home + "/.cache/viscera");
}

StepTimeCache StepTimeCache::asItIs() const {
  StepTimeCache out = *this;
  out.keeps_ = false;
  return out;
}

std::optional<StepTime> StepTimeCache::find(const std::string& key) const {
  if (file_.empty()) return std::nullopt;
  for (const Entry& entry : readEntries(file_)) {
    if (entry.key == key) return entry.time;
  }
  return std::nullopt;
}

void StepTimeCache::keep(const std::string& key, const StepTime& time) const {
  if (!keeps_ || file_.empty() || !makesSense(time)) return;
  const std::vector<Entry> others = readEntries(file_);
  const std::string draft = file_ + "." + std::to_string(getpid());  // whole or not at all for those who read meanwhile
  std::error_code error;
  fs::create_directories(fs::path(file_).parent_path(), error);
  {
    std::ofstream out(draft);
    out.precision(9);
    out << key << '\t' << time.overhead_s << '\t' << time.per_node_s << '\n';
    for (const Entry& other : others) {
      if (other.key != key) out << other.key << '\t' << other.time.overhead_s << '\t' << other.time.per_node_s << '\n';
    }
    if (!out.flush()) error = std::make_error_code(std::errc::io_error);
  }
  if (!error) fs::rename(draft, file_, error);
  if (error) fs::remove(draft, error);
}

}  // namespace viscera
