// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/plot.h"

#include <gtest/gtest.h>
#include <stdlib.h>

#include <limits>
#include <set>
#include <sstream>

#include "support/temporary_folder.h"
#include "support/text.h"

namespace viscera::bench {
namespace {

using test::TemporaryFolder;

std::string scriptOf(const Plot& plot) {
  std::ostringstream out;
  plot.writeScript(out, "p.png");
  return out.str();
}

Plot line() {
  Plot plot;
  plot.title = "it's a line";
  plot.series = {{"a_b", {1, 2, 3}, {10, 20, 30}}};
  return plot;
}

TEST(Plot, ScriptHoldsDataAndQuotedText) {
  EXPECT_TRUE(test::says(scriptOf(line()), {"set output 'p.png'", "set title 'it''s a line'", "\n1 10\n2 20\n3 30\n",
                                            "plot $series0 with linespoints", "title 'a_b'"}));
}

TEST(Plot, LeavesOutWhatALogAxisCannotShow) {
  Plot plot = line();
  plot.series[0].y = {0, std::numeric_limits<double>::quiet_NaN(), 30};
  EXPECT_TRUE(test::says(scriptOf(plot), {"\n1 0\n3 30\n"}));
  plot.log_y = true;
  EXPECT_TRUE(test::says(scriptOf(plot), {"set logscale y", "END_OF_SERIES\n3 30\nEND_OF_SERIES"}));
  plot.series[0].y = {0, -1, 0};
  EXPECT_FALSE(plot.hasPoints());
  EXPECT_EQ(scriptOf(plot).find("plot "), std::string::npos);
}

TEST(Plot, ALogAxisOfFewValuesIsLabelledWithThem) {
  Plot plot = line();
  EXPECT_EQ(scriptOf(plot).find("xtics"), std::string::npos);
  plot.log_x = true;
  EXPECT_TRUE(test::says(scriptOf(plot), {"set xtics (1, 2, 3)\n"}));
  plot.series[0].x[1] = 1.2345678;  // a measured value: too long for a label of the axis
  EXPECT_EQ(scriptOf(plot).find("xtics"), std::string::npos);
  plot.series[0].x.resize(20);
  plot.series[0].y.assign(20, 1);
  for (size_t i = 0; i < 20; ++i) plot.series[0].x[i] = static_cast<double>(i);
  EXPECT_EQ(scriptOf(plot).find("xtics"), std::string::npos);
}

TEST(Plot, NoTwoOfTwentyCurvesLookTheSame) {
  Plot plot;
  for (int i = 0; i < 20; ++i) plot.series.push_back({"s", {1, 2}, {1, 2}});
  std::istringstream script(scriptOf(plot));
  std::set<std::string> styles;
  for (std::string line; std::getline(script, line);) {
    const size_t with = line.find(" with linespoints");
    if (with != std::string::npos) styles.insert(line.substr(with, line.find(" title") - with));
  }
  EXPECT_EQ(styles.size(), 20u);
}

TEST(Plot, GnuplotDrawsAPng) {
  const TemporaryFolder folder;
  folder.write("p.gp", scriptOf(line()));
  ASSERT_EQ(runGnuplot(folder.path(), "p.gp"), Drawn::kYes);
  EXPECT_EQ(test::readFile(folder.file("p.png")).substr(0, 8), "\x89PNG\r\n\x1a\n");
}

TEST(Plot, SaysWhenTheScriptFails) {
  const TemporaryFolder folder;
  folder.write("p.gp", "plot nothing_of_this_name\n");
  EXPECT_EQ(runGnuplot(folder.path(), "p.gp"), Drawn::kFailed);
}

TEST(Plot, SaysWhenThereIsNoGnuplot) {
  const TemporaryFolder folder;
  const std::string path = getenv("PATH");
  setenv("PATH", folder.path().c_str(), 1);
  const Drawn drawn = runGnuplot(folder.path(), "p.gp");
  setenv("PATH", path.c_str(), 1);
  EXPECT_EQ(drawn, Drawn::kNoGnuplot);
}

}  // namespace
}  // namespace viscera::bench
