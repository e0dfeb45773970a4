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
  std::string out = "out/bench";  ///< folder of CSV files and plots; made if it is not there
  bool short_form = false;        ///< the form that scripts/test runs: under 20 s on two cores
  /// kCpu, kGpu: where the suites that judge results measure every row. One with the GPU needs a current context.
  std::vector<Backend> backends = {Backend::kCpu, Backend::kGpu};
  gpu::Context* context = nullptr;  ///< that one
  std::string only;                 ///< the part to measure, of suites that have parts; empty: all
  std::string data;                 ///< file of measured values, of suites that take one; empty: none
  std::vector<int> nodes;           ///< sizes of bodies, of suites that take them; empty: the suite's own
  std::string scene;                ///< in place of those bodies; empty: none
  Overrides overrides;              ///< of that scene
  int threads = 0;                  ///< of the CPU backend there; 0: as many as there are processors
};

/// One number that must be reached.
struct Check {
  std::string name;
  double measured, limit;
  bool at_least;  ///< the limit is a lower one
  bool ok;
};

/// What a suite finds: tables and plots as they come, checks at the end.
class Report {
 public:
  /// @param suite  its name: first word of every file name   @param text  tables are printed there
  /// @throws Error  the folder cannot be made
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
  /// Says on standard error what is measured next.
  void stage(const std::string& what) const;
  /// One line of text, such as what a table does not say.
  void note(const std::string& line);
  /// Prints the table and writes <out>/<suite>_<stem>.csv. @throws Error  it cannot be written
  void add(const Table& table, const std::string& stem);
  /// Writes <out>/<suite>_<stem>.gp and has gnuplot draw <suite>_<stem>.png; without gnuplot it says so, once.
  void add(const Plot& plot, const std::string& stem);
  /// Writes <out>/<suite>_<stem>.png. @param rgb  [3 * width * height] sRGB, rows from the top
  void add(const std::vector<uint8_t>& rgb, int width, int height, const std::string& stem);
  /// |measured| <= limit; what is not a number misses.
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

/// A part of a suite, which may be measured alone.
struct Part {
  const char* name;
  void (*measure)(Report& report);
};
/// Measures all parts, or the one that the report's options name. @throws Error  there is none of that name
void measureParts(Report& report, const std::vector<Part>& parts);

}  // namespace viscera::bench
