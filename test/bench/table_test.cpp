// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/table.h"

#include <gtest/gtest.h>

#include <limits>
#include <sstream>

namespace viscera::bench {
namespace {

std::string printed(const Table& table) {
  std::ostringstream out;
  table.print(out);
  return out.str();
}

std::string csvOf(const Table& table) {
  std::ostringstream out;
  table.writeCsv(out);
  return out.str();
}

TEST(Table, PrintsAlignedColumnsWithUnits) {
  Table table("Springs", {{"kind"}, {"k", "N/m", 3}});
  table.add({"axial", 1234.5678});
  table.add({"di", 2});
  EXPECT_EQ(printed(table),
            "Springs\n"
            "  kind    k [N/m]\n"
            "  axial  1.23e+03\n"
            "  di            2\n");
}

TEST(Table, WritesNineDigitsAsCsv) {
  Table table("t", {{"name"}, {"value", "m"}});
  table.add({"third", 1.0 / 3});
  EXPECT_EQ(csvOf(table), "name,value [m]\nthird,0.333333333\n");
}

TEST(Table, QuotesWordsThatHoldCommasAndQuotes) {
  Table table("t", {{"a, b"}, {"c"}});
  table.add({"say \"no\"", "plain"});
  EXPECT_EQ(csvOf(table), "\"a, b\",c\n\"say \"\"no\"\"\",plain\n");
}

TEST(Table, ShowsWhatIsNotANumber) {
  Table table("t", {{"x"}});
  table.add({std::numeric_limits<double>::quiet_NaN()});
  EXPECT_EQ(csvOf(table), "x\nnan\n");
}

TEST(Table, RefusesARowThatDoesNotFit) {
  Table table("t", {{"a"}, {"b"}});
  EXPECT_THROW(table.add({1.0}), std::invalid_argument);
  EXPECT_THROW(table.add({1.0, 2.0, 3.0}), std::invalid_argument);
  EXPECT_TRUE(table.rows().empty());
}

}  // namespace
}  // namespace viscera::bench
