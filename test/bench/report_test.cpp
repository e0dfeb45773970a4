// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/report.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <sstream>

#include "support/temporary_folder.h"
#include "support/text.h"
#include "viscera/math/error.h"

namespace viscera::bench {
namespace {

class Reporting : public ::testing::Test {
 protected:
  SuiteOptions optionsFor(const std::string& out) const {
    SuiteOptions options;
    options.out = out;
    return options;
  }

  test::TemporaryFolder folder_;
  std::ostringstream text_;
};

TEST_F(Reporting, MissesWhatIsOverItsLimitOrNotANumber) {
  Report report("suite", optionsFor(folder_.path()), text_);
  report.checkAtMost("small", -0.5, 1);
  report.checkAtMost("large", -1.5, 1);
  report.checkAtMost("nan", std::numeric_limits<double>::quiet_NaN(), 1);
  report.checkAtLeast("high", 2, 1);
  report.checkAtLeast("low", 0.5, 1);
  report.checkAtLeast("nan too", std::numeric_limits<double>::quiet_NaN(), 1);
  EXPECT_EQ(report.missed(), 4);
  report.finish();
  EXPECT_EQ(test::readFile(folder_.file("suite_checks.csv")),
            "check,measured,is,limit,verdict\n"
            "small,-0.5,<=,1,ok\nlarge,-1.5,<=,1,MISSED\nnan,nan,<=,1,MISSED\n"
            "high,2,>=,1,ok\nlow,0.5,>=,1,MISSED\nnan too,nan,>=,1,MISSED\n");
  EXPECT_TRUE(test::says(text_.str(), {"suite: 6 checks, 4 missed"}));
}

int g_measured[2] = {0, 0};

TEST_F(Reporting, MeasuresOnePartOrAll) {
  const std::vector<Part> parts = {{"first", [](Report&) { ++g_measured[0]; }},
                                   {"second", [](Report&) { ++g_measured[1]; }}};
  SuiteOptions options = optionsFor(folder_.path());
  Report all("suite", options, text_);
  measureParts(all, parts);
  options.only = "second";
  Report one("suite", options, text_);
  measureParts(one, parts);
  EXPECT_EQ(g_measured[0], 1);
  EXPECT_EQ(g_measured[1], 2);
  options.only = "third";
  Report none("suite", options, text_);
  try {
    measureParts(none, parts);
    FAIL();
  } catch (const Error& e) {
    EXPECT_STREQ(e.what(), "--only third: unknown part; suite suite has the parts first, second");
  }
}

TEST_F(Reporting, MakesItsFolderAndWritesTableAndPlotSideBySide) {
  const std::string out = folder_.file("a/b");
  Report report("suite", optionsFor(out), text_);
  Table table("T", {{"x"}});
  table.add({1});
  report.add(table, "first");
  Plot plot;
  plot.series = {{"s", {1, 2}, {3, 4}}};
  report.add(plot, "first");
  for (const char* extension : {".csv", ".gp", ".png"}) {
    EXPECT_TRUE(std::filesystem::exists(out + "/suite_first" + extension)) << extension;
  }
}

TEST_F(Reporting, TablesStandWithoutGnuplotAndOneLineSaysSo) {
  Report report("suite", optionsFor(folder_.path()), text_);
  Plot plot;
  plot.series = {{"s", {1, 2}, {3, 4}}};
  const std::string path = getenv("PATH");
  setenv("PATH", folder_.path().c_str(), 1);
  ::testing::internal::CaptureStderr();
  report.add(plot, "first");
  report.add(plot, "second");
  const std::string said = ::testing::internal::GetCapturedStderr();
  setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(std::count(said.begin(), said.end(), '\n'), 1) << said;
  EXPECT_TRUE(test::says(said, {"gnuplot is not installed"}));
  EXPECT_FALSE(std::filesystem::exists(folder_.file("suite_first.png")));
}

TEST_F(Reporting, RefusesAFolderThatCannotBeMade) {
  const std::string file = folder_.write("file", "");
  EXPECT_TRUE(test::says(test::messageOf<Error>([&] { Report("suite", optionsFor(file + "/x"), text_); }),
                         {"--out", "cannot be created"}));
}

}  // namespace
}  // namespace viscera::bench
