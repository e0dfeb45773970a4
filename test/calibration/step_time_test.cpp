// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/calibration/step_time.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "support/temporary_folder.h"

namespace viscera {
namespace {

using test::readFile;
using test::TemporaryFolder;

constexpr double kRounding = 1e-8;  ///< relative: nine digits are kept

void expectNear(const std::optional<StepTime>& found, const StepTime& kept) {
  ASSERT_TRUE(found.has_value());
  EXPECT_NEAR(found->overhead_s, kept.overhead_s, kRounding * kept.overhead_s);
  EXPECT_NEAR(found->per_node_s, kept.per_node_s, kRounding * kept.per_node_s);
}

TEST(StepTime, IsTheLineThroughTwoMeasurements) {
  const StepTime time = stepTimeThrough({1000, 7e-6}, {9000, 23e-6});
  EXPECT_NEAR(time.overhead_s, 5e-6, 1e-12);
  EXPECT_NEAR(time.per_node_s, 2e-9, 1e-15);
  EXPECT_NEAR(time.of(5000), 15e-6, 1e-12);
}

TEST(StepTime, IsInProportionToTheLargerWhereALineMakesNoSense) {
  for (const double small_s : {30e-6 /* slower than the larger */, 1e-6 /* below zero without nodes */}) {
    const StepTime time = stepTimeThrough({1000, small_s}, {8000, 20e-6});
    EXPECT_EQ(time.overhead_s, 0);
    EXPECT_NEAR(time.per_node_s, 2.5e-9, 1e-15);
  }
}

class StepTimeCacheTest : public ::testing::Test {
 protected:
  TemporaryFolder folder_;
  StepTimeCache cache_{folder_.file("viscera")};
  const StepTime time_{3.123456789e-6, 2.123456789e-9};
};

TEST_F(StepTimeCacheTest, FindsWhatWasKeptAndNothingElse) {
  EXPECT_FALSE(cache_.find("a machine; cpu"));
  cache_.keep("a machine; cpu", time_);
  expectNear(cache_.find("a machine; cpu"), time_);
  EXPECT_FALSE(cache_.find("a machine"));
  EXPECT_FALSE(cache_.find("a machine; cpu, governor"));
  EXPECT_FALSE(cache_.find(""));
}

TEST_F(StepTimeCacheTest, AsItIsItFindsAndKeepsNothing) {
  cache_.keep("a", time_);
  const StepTimeCache as_it_is = cache_.asItIs();
  expectNear(as_it_is.find("a"), time_);
  as_it_is.keep("b", time_);
  EXPECT_FALSE(cache_.find("b"));
}

TEST_F(StepTimeCacheTest, TheLatestOfAKeyCountsAndOthersStay) {
  cache_.keep("a", time_);
  cache_.keep("b", {0, 1e-9});
  cache_.keep("b", {0, 4e-9});
  expectNear(cache_.find("a"), time_);
  expectNear(cache_.find("b"), {0, 4e-9});
}

TEST_F(StepTimeCacheTest, LinesThatMakeNoSenseAreNotBelieved) {
  cache_.keep("good", time_);
  const std::string good = readFile(cache_.file());
  for (const char* bad : {"a", "a\t", "a\t1e-6", "a\tx\t1e-9", "a\t1e-6\t1e-9\t7", "a\t-1e-6\t1e-9", "a\t1e-6\t0",
                          "a\tnan\t1e-9", "a\t0\tinf", "\t0\t1e-9", "\xff\xfe{[", ""}) {
    folder_.write("viscera/step_times.tsv", std::string(bad) + "\n" + good);
    EXPECT_FALSE(cache_.find("a")) << bad;
    EXPECT_FALSE(cache_.find("")) << bad;
    expectNear(cache_.find("good"), time_);
  }
  cache_.keep("a", {0, 5e-9});  // puts the file right
  expectNear(cache_.find("a"), {0, 5e-9});
  expectNear(cache_.find("good"), time_);
}

TEST_F(StepTimeCacheTest, OldestAreForgottenWhereTheyAreMany) {
  for (int i = 0; i < 200; ++i) cache_.keep(std::to_string(i), time_);
  EXPECT_FALSE(cache_.find("0"));
  expectNear(cache_.find("199"), time_);
  EXPECT_LT(std::filesystem::file_size(cache_.file()), 5000u);
}

TEST_F(StepTimeCacheTest, PlaceThatCannotBeWrittenIsNoError) {
  const StepTimeCache below_a_file(folder_.write("file", "") + "/viscera"), nowhere("");
  for (const StepTimeCache* cache : {&below_a_file, &nowhere}) {
    cache->keep("a", time_);
    EXPECT_FALSE(cache->find("a"));
  }
  std::filesystem::create_directories(folder_.file("taken/step_times.tsv/x"));  // a folder where the file should be
  const StepTimeCache taken(folder_.file("taken"));
  taken.keep("a", time_);
  EXPECT_FALSE(taken.find("a"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.file("taken")), {}), 1) << "a draft was left";
}

TEST_F(StepTimeCacheTest, LeavesNoDraftBehind) {
  cache_.keep("a", time_);
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.file("viscera")), {}), 1);
}

}  // namespace
}  // namespace viscera
