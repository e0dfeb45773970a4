// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/report.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "export/png_writer.h"
#include "viscera/math/error.h"

namespace viscera::bench {

namespace fs = std::filesystem;

Report::Report(std::string suite, SuiteOptions options, std::ostream& text)
    : suite_(std::move(suite)), options_(std::move(options)), text_(text) {
  std::error_code error;
  fs::create_directories(options_.out, error);
  if (!fs::is_directory(options_.out))
    throw Error("--out " + options_.out + ": the folder does not exist and cannot be created");
}

void Report::stage(const std::string& what) const {
  std::cerr << suite_ << ": " << what << std::endl;
}

void Report::note(const std::string& line) {
  text_ << line << '\n';
}

std::string Report::fileName(const std::string& stem, const std::string& extension) const {
  return suite_ + "_" + stem + extension;
}

std::ofstream Report::open(const std::string& file_name) const {
  const std::string path = (fs::path(options_.out) / file_name).string();
  std::ofstream file(path);
  if (!file) throw Error(path + ": cannot be written");
  return file;
}

void Report::add(const Table& table, const std::string& stem) {
  table.print(text_);
  text_ << std::endl;
  std::ofstream file = open(fileName(stem, ".csv"));
  table.writeCsv(file);
  if (!file.flush()) throw Error(fileName(stem, ".csv") + ": cannot be written");
}

void Report::add(const Plot& plot, const std::string& stem) {
  if (!plot.hasPoints()) {
    note("no plot '" + plot.title + "': it has no points");
    return;
  }
  const std::string script = fileName(stem, ".gp");
  std::ofstream file = open(script);
  plot.writeScript(file, fileName(stem, ".png"));
  file.close();
  const Drawn drawn = runGnuplot(options_.out, script);
  if (drawn == Drawn::kNoGnuplot && !said_no_gnuplot_) {
    std::cerr << suite_ << ": gnuplot is not installed, so there are no plots; the tables are in " << options_.out
              << std::endl;
    said_no_gnuplot_ = true;
  }
  if (drawn == Drawn::kFailed) std::cerr << suite_ << ": gnuplot could not draw " << script << std::endl;
}

void Report::add(const std::vector<uint8_t>& rgb, int width, int height, const std::string& stem) {
  writePng((fs::path(options_.out) / fileName(stem, ".png")).string(), width, height, rgb);
}

void Report::checkAtMost(const std::string& name, double measured, double limit) {
  checks_.push_back({name, measured, limit, false, std::abs(measured) <= limit});
}

void Report::checkAtLeast(const std::string& name, double measured, double limit) {
  checks_.push_back({name, measured, limit, true, measured >= limit});
}

void Report::finish() {
  Table table("Checks of " + suite_, {{"check"}, {"measured"}, {"is"}, {"limit"}, {"verdict"}});
  for (const Check& check : checks_) {
    table.add({check.name, check.measured, check.at_least ? ">=" : "<=", check.limit, check.ok ? "ok" : "MISSED"});
  }
  add(table, "checks");
  text_ << suite_ << ": " << checks_.size() << " checks, " << missed() << " missed" << std::endl;
}

int Report::missed() const {
  return static_cast<int>(std::count_if(checks_.begin(), checks_.end(), [](const Check& c) { return !c.ok; }));
}

void measureParts(Report& report, const std::vector<Part>& parts) {
  std::string names;
  bool found = report.only().empty();
  for (const Part& part : parts) {
    names += std::string(names.empty() ? "" : ", ") + part.name;
    found = found || report.only() == part.name;
  }
  if (!found)
    throw Error("--only " + report.only() + ": unknown part; suite " + report.suite() + " has the parts " + names);
  for (const Part& part : parts) {
    if (report.only().empty() || report.only() == part.name) part.measure(report);
  }
}

}  // namespace viscera::bench
