// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "cli/sweep_folder.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "math/number_text.h"
#include "math/one_line.h"
#include "math/out_file.h"
#include "viscera/math/error.h"

namespace viscera::cli {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::string readWhole(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  TextOut out;
  out << file.rdbuf();
  return out.str();
}

bool exists(const std::string& path) {
  std::error_code error;
  return fs::exists(path, error);
}

/// Returns the value of a metric in a result as text; empty if there is none.
std::string resultOf(const Json& result, const std::string& name) {
  const auto found = result.find(name);
  if (found == result.end()) return "";
  return found->is_string() ? found->get<std::string>() : found->dump();
}

/// Returns the names of the metrics, in the order of the results.
std::vector<std::string> metricsOf(const std::vector<Json>& results) {
  std::vector<std::string> out;
  for (const Json& result : results) {
    for (const auto& item : result.items()) {
      const bool scalar = item.value().is_primitive();
      if (scalar && std::count(out.begin(), out.end(), item.key()) == 0) out.push_back(item.key());
    }
  }
  return out;
}

std::string valueOf(const KeyValues& run, const std::string& key) {
  const auto found = std::find_if(run.begin(), run.end(), [&](const auto& value) { return value.first == key; });
  return found == run.end() ? "" : found->second;
}

}  // namespace

SweepFolder::Claim::Claim(Claim&& other) noexcept : file_(std::exchange(other.file_, -1)) {}

SweepFolder::Claim::~Claim() {
  if (file_ >= 0) close(file_);
}

SweepFolder::SweepFolder(std::string folder, const SweepPlan& plan, int tries)
    : folder_(std::move(folder)), plan_(plan), tries_(static_cast<size_t>(tries)) {
  std::error_code error;
  fs::create_directories(folder_ + "/runs", error);
  const std::string file = folder_ + "/plan.txt", text = plan.text();
  if (!exists(file)) writeFile(file, FileKind::kText, text);
  if (readWhole(file) != text)
    throw Error(folder_ + " contains the runs of another plan (plan.txt differs); choose another --out");
}

std::string SweepFolder::runFolder(size_t run) const {
  char name[32];
  std::snprintf(name, sizeof name, "/runs/%06zu", run);
  return folder_ + name;
}

std::vector<std::string> SweepFolder::failuresOf(size_t run) const {
  std::ifstream file(runFolder(run) + "/failures.txt");
  std::vector<std::string> out;
  for (std::string line; std::getline(file, line);) out.push_back(line);
  return out;
}

SweepFolder::State SweepFolder::state(size_t run) const {
  if (exists(runFolder(run) + "/result.json")) return State::kDone;
  return failuresOf(run).size() >= tries_ ? State::kGivenUp : State::kOpen;
}

std::optional<SweepFolder::Claim> SweepFolder::claim(size_t run) const {
  std::error_code error;
  fs::create_directories(runFolder(run), error);
  const std::string path = runFolder(run) + "/lock";
  Claim claim(open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666));
  if (claim.file_ < 0) throw Error(path + ": " + std::strerror(errno));
  if (flock(claim.file_, LOCK_EX | LOCK_NB) != 0) {
    if (errno == EWOULDBLOCK) return {};
    throw Error(path + " cannot be locked: " + std::strerror(errno) + "; --out must be on a file system with locks");
  }
  if (state(run) != State::kOpen) return {};
  return claim;
}

void SweepFolder::keepResult(size_t run, const std::string& json) const {
  writeFile(runFolder(run) + "/result.json", FileKind::kJson, json + "\n");
}

void SweepFolder::keepFailure(size_t run, const std::string& line) const {
  std::ofstream file(runFolder(run) + "/failures.txt", std::ios::app);
  file << oneLine(line) << std::endl;
  if (!file) throw Error(runFolder(run) + "/failures.txt: cannot be written");
}

void SweepFolder::clearFailures() const {
  std::error_code error;
  for (size_t run = 0; run < plan_.runs.size(); ++run) fs::remove(runFolder(run) + "/failures.txt", error);
}

SweepTable SweepFolder::table() const {
  std::vector<Json> results;
  SweepTable out;
  SweepTable::Column number{"run", {}}, ended{"ended", {}};
  SweepTable::Column failed{"failures", {}}, last{"last_failure", {}};
  for (size_t run = 0; run < plan_.runs.size(); ++run) {
    results.push_back(Json::parse(readWhole(runFolder(run) + "/result.json"), nullptr, false));
    if (!results.back().is_object()) results.back() = Json::object();
    const std::vector<std::string> failures = failuresOf(run);
    const State now = state(run);
    number.cells.push_back(std::to_string(run));
    ended.cells.emplace_back(now == State::kDone ? "done" : now == State::kGivenUp ? "failed" : "open");
    failed.cells.push_back(std::to_string(failures.size()));
    last.cells.push_back(failures.empty() ? "" : failures.back());
  }
  out.columns = {number, ended, failed};
  for (const std::string& key : plan_.varied) {
    SweepTable::Column column{key, {}};
    for (const KeyValues& run : plan_.runs) column.cells.push_back(valueOf(run, key));
    out.columns.push_back(std::move(column));
  }
  for (const std::string& name : metricsOf(results)) {
    SweepTable::Column column{name, {}};
    for (const Json& result : results) column.cells.push_back(resultOf(result, name));
    out.columns.push_back(std::move(column));
  }
  out.columns.push_back(std::move(last));
  return out;
}

void SweepFolder::writeTable() const {
  writeFile(folder_ + "/results.csv", FileKind::kText, csvText(table()));
}

}  // namespace viscera::cli
