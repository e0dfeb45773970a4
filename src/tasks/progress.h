// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace viscera {

/// Result of an attempt, as its report.json states it.
struct AttemptResult {
  std::string file;  ///< path of its report.json
  std::string task, title, trainee, date, state;
  double score = 0, pass_score = 0, time_s = 0;
};

/// Reports in a folder.
struct AttemptList {
  std::vector<AttemptResult> attempts;  ///< by date, then by path
  std::vector<std::string> skipped;     ///< files that are not reports, and why
};

/// Reads the text of a report.json. @throws Error  why it is none, without the name of the file
AttemptResult readAttempt(const std::string& json);
/// Reads all files report.json in a folder and its subfolders. Links are not followed.
/// @throws Error  the folder cannot be read
AttemptList readProgress(const std::string& folder);

/// Returns a page with a table of the attempts, and for each task the score of each trainee over attempts.
/// @param folder  of the page; reports that it links to have paths relative to it
std::string progressPage(const AttemptList& progress, const std::string& folder);

}  // namespace viscera
