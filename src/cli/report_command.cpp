// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <filesystem>
#include <iostream>
#include <set>

#include "cli/commands.h"
#include "math/one_line.h"
#include "math/out_file.h"
#include "tasks/progress.h"
#include "viscera/math/error.h"

namespace viscera::cli {

int report(ReportOptions options) {
  if (!std::filesystem::is_directory(options.folder))
    throw Error(options.folder + ": is not a folder; `viscera report` needs one with reports of `viscera task --out`");
  if (options.out.empty()) options.out = (std::filesystem::path(options.folder) / "progress.html").string();
  requireReplaceable(options.out, FileKind::kHtml);
  const AttemptList progress = readProgress(options.folder);
  for (const std::string& file : progress.skipped) std::cout << "skipped: " << oneLine(file) << '\n';
  if (progress.attempts.empty())
    throw Error(options.folder + ": has no report of a task; " + std::to_string(progress.skipped.size()) +
                " files report.json were skipped");
  std::set<std::string> tasks, trainees;
  for (const AttemptResult& attempt : progress.attempts) {
    tasks.insert(attempt.task);
    trainees.insert(attempt.trainee);
  }
  const std::filesystem::path parent = std::filesystem::absolute(options.out).parent_path();
  writeFile(options.out, FileKind::kHtml, progressPage(progress, parent.string()));
  std::cout << "attempts: " << progress.attempts.size() << ", tasks: " << tasks.size()
            << ", trainees: " << trainees.size() << ", skipped files: " << progress.skipped.size() << '\n'
            << "Progress: " << oneLine(options.out) << '\n';
  return 0;
}

}  // namespace viscera::cli
