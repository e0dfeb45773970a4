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
#include <sstream>
#include <utility>

#include "math/one_line.h"
#include "viscera/math/error.h"

namespace viscera::cli {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// Written beside its place and moved there, so that nobody reads half of it.
void writeWhole(const std::string& path, const std::string& text) {
  const std::string draft = path + "." + std::to_string(getpid()) + ".draft";
  std::ofstream file(draft, std::ios::binary);
  file << text;
  file.close();
  std::error_code error;
  if (file) fs::rename(draft, path, error);
  if (!file || error) throw Error(path + ": cannot be written");
}

std::string readWhole(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream out;
  out << file.rdbuf();
  return out.str();
}

bool exists(const std::string& path) {
  std::error_code error;
  return fs::exists(path, error);
}

/// A cell of a CSV file (RFC 4180).
std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

std::string valueCell(const Json& json, const std::string& name) {
  const auto found = json.find(name);
  if (found == json.end()) return "";
  return cell(found->is_string() ? found->get<std::string>() : found->dump());
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
  if (!exists(file)) writeWhole(file, text);
  if (readWhole(file) != text)
    throw Error(folder_ + " holds the runs of another plan (plan.txt differs): take another --out");
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
    throw Error(path + " cannot be locked, " + std::strerror(errno) + ": --out must be on a file system with locks");
  }
  if (state(run) != State::kOpen) return {};
  return claim;
}

void SweepFolder::keepResult(size_t run, const std::string& json) const {
  writeWhole(runFolder(run) + "/result.json", json + "\n");
}

void SweepFolder::keepFailure(size_t run, const std::string& line) const {
  std::ofstream file(runFolder(run) + "/failures.txt", std::ios::app);
  file << oneLine(line) << std::endl;
  if (!file) throw Error(runFolder(run) + "/failures.txt: cannot be written");
}

void SweepFolder::forgetFailures() const {
  std::error_code error;
  for (size_t run = 0; run < plan_.runs.size(); ++run) fs::remove(runFolder(run) + "/failures.txt", error);
}

void SweepFolder::writeTable() const {
  std::vector<Json> results;
  std::vector<std::string> metrics;
  for (size_t run = 0; run < plan_.runs.size(); ++run) {
    results.push_back(Json::parse(readWhole(runFolder(run) + "/result.json"), nullptr, false));
    if (!results.back().is_object()) results.back() = Json::object();
    for (const auto& item : results.back().items()) {
      const bool scalar = item.value().is_primitive();
      if (scalar && std::count(metrics.begin(), metrics.end(), item.key()) == 0) metrics.push_back(item.key());
    }
  }
  std::string table = "run,ended,failures";
  for (const std::string& key : plan_.varied) table += "," + cell(key);
  for (const std::string& name : metrics) table += "," + cell(name);
  table += ",last_failure\n";
  for (size_t run = 0; run < plan_.runs.size(); ++run) {
    const std::vector<std::string> failures = failuresOf(run);
    const State now = state(run);
    table += std::to_string(run) +
             (now == State::kDone      ? ",done,"
              : now == State::kGivenUp ? ",failed,"
                                       : ",open,") +
             std::to_string(failures.size());
    for (const std::string& key : plan_.varied) {
      const auto found = std::find_if(plan_.runs[run].begin(), plan_.runs[run].end(),
                                      [&](const auto& value) { return value.first == key; });
      table += "," + (found == plan_.runs[run].end() ? "" : cell(found->second));
    }
    for (const std::string& name : metrics) table += "," + valueCell(results[run], name);
    table += "," + (failures.empty() ? "" : cell(failures.back())) + "\n";
  }
  writeWhole(folder_ + "/results.csv", table);
}

}  // namespace viscera::cli
