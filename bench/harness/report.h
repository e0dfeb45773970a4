// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <fstream>
#include <string>
#include <vector>

#include "bench/harness/plot.h"
#include "bench/harness/table.h"
#include "viscera/model/scene/overrides.h"
#include "viscera/model/scene/solver_kinds.h"

namespace viscera::gpu {
class Context;
}

namespace viscera::bench {

struct SuiteOptions {
  std::string out = "out/bench";  ///< folder of CSV files and plots; created if necessary
  bool short_form = false;        ///< the form that scripts/test runs: under 20 s on two cores
  /// Backends on which the suites with pass criteria measure every row: kCpu, kGpu. The GPU requires a current context.
  std::vector<Backend> backends = {Backend::kCpu, Backend::kGpu};
  gpu::Context* context = nullptr;  ///< context for the GPU
  std::string only;                 ///< name of the only part to measure, for suites with parts; empty: all
  std::string data;                 ///< file of measured values, for suites that take one; empty: none
  std::vector<int> nodes;           ///< sizes of bodies, for suites that take them; empty: the suite's own
  std::string scene;                ///< scene that replaces those bodies; empty: none
  Overrides overrides;              ///< overrides of that scene
  int threads = 0;                  ///< threads of the CPU backend for it; 0: number of CPU cores
};

/// A number with a limit.
struct Check {
  std::string name;
  double measured, limit;
  bool at_least;  ///< whether the limit is a lower bound
  bool ok;
};

/// The results of a suite: tables and plots as they are measured, checks at the end.
class Report {
 public:
  /// @param suite  name, the prefix of every file name   @param text  stream to which tables are printed
  /// @throws Error  the folder cannot be created
  Report(std::string suite, SuiteOptions options, std::ostream& text);

  bool isShort() const { return options_.short_form; }
  const std::string& only() const { return options_.only; }
  const std::string& data() const { return options_.data; }
  const std::vector<int>& nodes() const { return options_.nodes; }
  const std::string& scene() const { return options_.scene; }
  const Overrides& overrides() const { return options_.overrides; }
  int threads() const { return options_.threads; }
  const std::vector<Backend>& backends() const { return options_.backends; }
  gpu::Context* context() const { return options_.context; }  ///< null: no GPU backend
  const std::string& suite() const { return suite_; }
  /// Prints on standard error what is measured next.
  void stage(const std::string& what) const;
  /// Prints one line of text, for remarks that are not in a table.
  void note(const std::string& line);
  /// Prints the table and writes <out>/<suite>_<stem>.csv. @throws Error  it cannot be written
  void add(const Table& table, const std::string& stem);
  /// Writes <out>/<suite>_<stem>.gp and runs gnuplot to draw <suite>_<stem>.png; reports a missing gnuplot once.
  void add(const Plot& plot, const std::string& stem);
  /// Writes <out>/<suite>_<stem>.png. @param rgb  [3 * width * height] sRGB, rows from the top
  void add(const std::vector<uint8_t>& rgb, int width, int height, const std::string& stem);
  /// Checks |measured| <= limit; NaN fails.
  void checkAtMost(const std::string& name, double measured, double limit);
  void checkAtLeast(const std::string& name, double measured, double limit);
  /// Prints all checks and writes <out>/<suite>_checks.csv.
  void finish();
  const std::vector<Check>& checks() const { return checks_; }
  int missed() const;

 private:
  std::string fileName(const std::string& stem, const std::string& extension) const;
  std::ofstream open(const std::string& file_name) const;

  std::string suite_;
  SuiteOptions options_;
  std::ostream& text_;
  std::vector<Check> checks_;
  bool said_no_gnuplot_ = false;
};

/// A part of a suite, which can be measured alone.
struct Part {
  const char* name;
  void (*measure)(Report& report);
};
/// Measures all parts, or the one in the report's options. @throws Error  there is no part of that name
void measureParts(Report& report, const std::vector<Part>& parts);

}  // namespace viscera::bench
