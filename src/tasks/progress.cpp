// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tasks/progress.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <tuple>

#include "tasks/attempt.h"
#include "tasks/task_watch.h"
#include "viscera/math/error.h"

namespace viscera {

namespace {

namespace fs = std::filesystem;
using AttemptJson = nlohmann::json;

constexpr uintmax_t kLargestReport = 10'000'000;  // bytes; ours have some thousand

const AttemptJson& valueOf(const AttemptJson& map, const char* key) {
  const auto found = map.find(key);
  if (found == map.end()) throw Error(std::string("'") + key + "' is missing");
  return *found;
}

std::string textAt(const AttemptJson& map, const char* key) {
  const AttemptJson& value = valueOf(map, key);
  if (!value.is_string()) throw Error(std::string("'") + key + "' must be a text");
  return value.get<std::string>();
}

double numberAt(const AttemptJson& map, const char* key) {
  const AttemptJson& value = valueOf(map, key);
  const double number = value.is_number() ? value.get<double>() : NAN;
  if (!std::isfinite(number) || number < 0) throw Error(std::string("'") + key + "' must be a number, 0 or more");
  return number;
}

AttemptResult attemptIn(const fs::path& file) {
  std::error_code error;
  const uintmax_t bytes = fs::file_size(file, error);
  if (error) throw Error("cannot be read: " + error.message());
  if (bytes > kLargestReport) throw Error("is larger than " + std::to_string(kLargestReport) + " bytes");
  std::ifstream stream(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (!stream) throw Error("cannot be read");
  AttemptResult out = readAttempt(text);
  out.file = file.string();
  return out;
}

/// Returns the files report.json below a folder.
std::vector<fs::path> reportsBelow(const std::string& folder) {
  std::vector<fs::path> out;
  std::error_code error;
  auto entry = fs::recursive_directory_iterator(folder, fs::directory_options::skip_permission_denied, error);
  for (; !error && entry != fs::recursive_directory_iterator(); entry.increment(error)) {
    std::error_code unknown;
    if (entry->path().filename() == "report.json" && entry->is_regular_file(unknown)) out.push_back(entry->path());
  }
  if (error) throw Error(folder + ": cannot read this folder of reports: " + error.message());
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

AttemptResult readAttempt(const std::string& json) {
  const AttemptJson report = AttemptJson::parse(json, nullptr, false);
  if (report.is_discarded()) throw Error("is not JSON");
  if (!report.is_object()) throw Error("is not a report of a task: it must be a map");
  AttemptResult out;
  out.task = textAt(report, "task");
  out.title = textAt(report, "title");
  out.state = textAt(report, "state");
  if (out.state != nameOf(TaskPhase::kPassed) && out.state != nameOf(TaskPhase::kFailed))
    throw Error("'state' must be passed or failed");
  out.score = numberAt(report, "score");
  out.pass_score = numberAt(report, "pass_score");
  out.time_s = numberAt(report, "time_s");
  const AttemptJson& attempt = valueOf(report, "attempt");
  if (!attempt.is_object()) throw Error("'attempt' must be a map");
  out.trainee = textAt(attempt, "name");
  const std::string fault = out.trainee.empty() ? "" : traineeFault(out.trainee);
  if (!fault.empty()) throw Error("'attempt.name': " + fault);
  out.date = textAt(attempt, "date");
  if (!isUtcText(out.date)) throw Error("'attempt.date' must be a time such as 2026-01-31T12:00:00Z");
  return out;
}

AttemptList readProgress(const std::string& folder) {
  AttemptList out;
  for (const fs::path& file : reportsBelow(folder)) {
    try {
      out.attempts.push_back(attemptIn(file));
    } catch (const Error& error) {
      out.skipped.push_back(file.string() + ": " + error.what());
    }
  }
  std::sort(out.attempts.begin(), out.attempts.end(), [](const AttemptResult& a, const AttemptResult& b) {
    return std::tie(a.date, a.file) < std::tie(b.date, b.file);
  });
  return out;
}

}  // namespace viscera
