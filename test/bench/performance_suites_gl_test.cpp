// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "bench/suites/suites.h"
#include "support/process.h"
#include "support/source_folder.h"
#include "support/text.h"

namespace viscera::bench {
namespace {

#ifdef VISCERA_HAS_COMMAND

/// A suite in its short form and its output; each is run once. Times are not checked, as the machine may be busy.
class PerformanceSuite : public ::testing::Test {
 protected:
  void run(const std::string& suite, const std::vector<std::string>& more = {}) {
    suite_ = suite;
    std::vector<std::string> arguments = {"bench", suite, "--short", "--out", folder_.path()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    ending_ = test::runProgram(kCommand, arguments);
    ASSERT_EQ(ending_.status, 0) << ending_.out << ending_.err;
  }
  /// Returns the lines of a table below its head.
  std::vector<std::string> rows(const std::string& table) const {
    std::vector<std::string> lines = test::linesOf(test::readFile(folder_.file(suite_ + "_" + table + ".csv")));
    if (!lines.empty()) lines.erase(lines.begin());
    return lines;
  }
  /// Returns the number of rows that contain all of some words.
  size_t rowsWith(const std::string& table, const std::vector<std::string>& words) const {
    size_t count = 0;
    for (const std::string& row : rows(table)) count += test::says(row, words) ? 1 : 0;
    return count;
  }

  test::TemporaryFolder folder_;
  std::string suite_;
  test::Ending ending_;
};

TEST_F(PerformanceSuite, SizesHaveEveryWayOfEveryBodyBesideThePaper) {
  run("speed", {"--only", "sizes", "--nodes", "10000", "130000"});
  for (const std::string variant : {"cpu scalar", "cpu simd, 1 thread", "cpu simd, all threads", "gpu"})
    EXPECT_EQ(rowsWith("sizes", {"heart", variant}), 2u) << variant;  // dashpot 0 and 0.2
  EXPECT_EQ(rowsWith("sizes", {"839.8"}), 12u);   // VR05 at 10,000 nodes, next to all but the scalar loop
  EXPECT_EQ(rowsWith("sizes", {"cube,13"}), 3u);  // a large one: no scalar loop, no heart
  EXPECT_EQ(rows("machine").size(), 3u);
}

TEST_F(PerformanceSuite, SizesNeedNoGpu) {
  run("speed", {"--only", "sizes", "--nodes", "1000", "--backend", "cpu"});
  EXPECT_EQ(rows("sizes").size(), 12u);  // two bodies, two dashpots, three methods
  EXPECT_EQ(rows("machine").size(), 2u);
  EXPECT_EQ(rowsWith("sizes", {",gpu,"}), 0u);
}

TEST_F(PerformanceSuite, HapticsHasARowOfEachCellAndMeetsItsChecks) {
  run("haptics");
  EXPECT_EQ(rows("matrix").size(), 16u);         // two tissues, delays, masses, drivers
  EXPECT_EQ(rowsWith("matrix", {",no,"}), 16u);  // limit cycles
  EXPECT_EQ(rows("events").size(), 8u);          // four events, two drivers
  EXPECT_EQ(rowsWith("events", {",no,"}), 8u);
  EXPECT_EQ(rowsWith("once_per_tick", {",yes,"}), 1u);
  EXPECT_EQ(rowsWith("needle", {",no,"}), 28u);  // two devices, drivers; surface twice, inside, through, between
  EXPECT_EQ(rowsWith("thread", {",no,"}), 12u);  // pulled twice, and out
  EXPECT_EQ(rowsWith("checks", {"needle, ", ",ok"}), 5u) << ending_.out;
  EXPECT_EQ(rowsWith("checks", {"thread, ", ",ok"}), 5u) << ending_.out;
}

TEST_F(PerformanceSuite, SpeedHasARowOfEachPartOnEachBackend) {
  run("speed");
  EXPECT_GE(rows("simd").size(), 2u);
  EXPECT_EQ(rows("explicit").size(), 16u);  // two bodies, two dashpots, two connections, two backends
  EXPECT_EQ(rows("heart").size(), 4u);
  EXPECT_EQ(rows("sessions").size(), 6u);
  EXPECT_EQ(rows("ticks").size(), 4u);
  EXPECT_GE(rows("stages").size(), 12u);
  for (const std::string feature : {"dashpot", "strengths by part", "contacts", "cuts", "cautery", "compensated sums",
                                    "stability_monitor", "cut state", "fixed nodes"})
    EXPECT_EQ(rowsWith("features", {feature}), 2u) << feature;
  EXPECT_EQ(rowsWith("cells", {"cube, full cells"}), 3u);  // one thread, all threads, GPU
  EXPECT_EQ(rowsWith("cells", {"heart"}), 3u);
  EXPECT_EQ(rowsWith("sleep", {",cpu,"}), 2u);
  EXPECT_EQ(rowsWith("sleep", {",gpu,"}), 3u);
  EXPECT_EQ(rows("views").size(), 14u);
  // These do not depend on time and hold on any machine.
  EXPECT_EQ(rowsWith("checks", {"largest difference", ",ok"}), 1u) << ending_.out;
  EXPECT_EQ(rowsWith("checks", {"not wanted", ",ok"}), 2u) << ending_.out;
}

TEST_F(PerformanceSuite, CutHasEveryShareOnEachBackend) {
  run("cut");
  EXPECT_EQ(rows("shares").size(), 12u);           // two bodies, two backends, three shares
  EXPECT_EQ(rows("incision").size(), 6u);          // two backends, uncut and two lengths
  EXPECT_EQ(rowsWith("incision", {",0,0,"}), 2u);  // the others cut something
}

TEST_F(PerformanceSuite, EgveHasTimeAndErrorOfEachMapping) {
  run("egve");
  for (const std::string mapping : {"one_to_one", "constant", "interpolated", "along_normal", "auto"}) {
    EXPECT_EQ(rowsWith("times", {"," + mapping + ","}), 4u) << mapping;    // two bodies, two backends
    EXPECT_EQ(rowsWith("errors", {"," + mapping + ","}), 12u) << mapping;  // two fillings, three motions, two lattices
    EXPECT_EQ(rowsWith("finer", {"," + mapping + ","}), 3u) << mapping;
  }
  EXPECT_EQ(rowsWith("times", {"6.67"}), 0u);  // only for bodies of the paper's size
  EXPECT_EQ(rows("checks").size(), 4u);
  EXPECT_EQ(rowsWith("checks", {"MISSED"}), 0u);
}

TEST_F(PerformanceSuite, LatencyHasForceSurfaceAndImageOnEachBackend) {
  run("latency");
  EXPECT_EQ(rowsWith("delays", {"pose to force"}), 8u) << ending_.out;
  EXPECT_EQ(rowsWith("delays", {"pose to surface"}), 4u) << ending_.out;
  EXPECT_EQ(rowsWith("delays", {"pose to image"}), 4u) << ending_.out;
  EXPECT_EQ(rowsWith("delays", {"jitter of ticks"}), 8u) << ending_.out;
}

TEST_F(PerformanceSuite, PictureHasEveryWayWithItsStagesAndLooksTheSame) {
  run("picture");
  for (const std::string tissue : {"whole", "cut"}) {
    EXPECT_EQ(rowsWith("pictures", {tissue + ","}), 4u) << ending_.out;
    EXPECT_EQ(rowsWith("stages", {tissue + ","}), 4u);
    EXPECT_EQ(rowsWith("looks", {tissue + ","}), 8u);
  }
  EXPECT_EQ(rowsWith("checks", {"SSIM", ",ok"}), 2u) << ending_.out;
  EXPECT_EQ(rowsWith("checks", {"time of a picture"}), 2u);
  EXPECT_GT(test::readFile(folder_.file("picture_whole_automatic.png")).size(), 50000u);
}

TEST_F(PerformanceSuite, GpuHasEveryPart) {
  run("gpu");
  EXPECT_GE(rows("groups").size(), 2u);
  EXPECT_EQ(rows("reads").size(), 5u);
  EXPECT_EQ(rowsWith("checks", {",ok"}), 3u) << ending_.out;
  EXPECT_EQ(rows("limits").size(), 2u);
  EXPECT_EQ(rowsWith("kernels", {"leapfrog.comp"}), 6u);  // springs and a law, with and without tables, a probe
  EXPECT_EQ(rowsWith("kernels", {"cell_forces.comp"}), 3u);
  EXPECT_EQ(rows("faces").size(), 3u);
  EXPECT_EQ(rowsWith("faces", {"10000000,,,,,"}), 1u) << "left out, with a reason";
  EXPECT_EQ(rows("flight").size(), 4u);
  EXPECT_EQ(rows("live").size(), 2u);
  EXPECT_EQ(rows("bytes").size(), 4u);
}

TEST_F(PerformanceSuite, GpuNamesItsPartsWhereOneIsAskedForThatIsNotThere) {
  const test::Ending wrong =
      test::runProgram(kCommand, {"bench", "gpu", "--short", "--out", folder_.path(), "--only", "everything"});
  EXPECT_NE(wrong.status, 0);
  EXPECT_TRUE(test::says(wrong.err, {"groups", "reads", "kernels", "faces", "flight", "live", "bytes"})) << wrong.err;
}

TEST_F(PerformanceSuite, BusyHasEveryNumberOfThreadsBesideEachLoad) {
  run("busy");
  for (const std::string load : {"none", "one of lowest priority", "two of normal priority"})
    EXPECT_EQ(rowsWith("rates", {load}), 3u) << load;  // one thread, two, auto
  EXPECT_EQ(rows("checks").size(), 4u);
}

#endif  // VISCERA_HAS_COMMAND

}  // namespace
}  // namespace viscera::bench
