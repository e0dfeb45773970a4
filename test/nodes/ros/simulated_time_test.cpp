// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/ros/simulated_time.h"

#include <gtest/gtest.h>

#include <array>
#include <string>

#include "nodes/ros/relaunch.h"
#include "nodes/ros/slowness.h"

namespace viscera::nodes {
namespace {

constexpr double kTick_s = 0.01;
constexpr double kSimulatedTimeRounding_s = 1e-6;  // the clock counts nanoseconds
const SimulatedTime::SteadyTime kStart = std::chrono::steady_clock::now();

SimulatedTime::SteadyTime at(double time_s) {
  return kStart + std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(time_s));
}

TEST(SimulatedTime, IsZeroUntilItIsSet) {
  SimulatedTime time;
  EXPECT_EQ(time.at(at(5)), 0);
  time.tell(3, kTick_s, at(5));
  EXPECT_NEAR(time.at(at(5)), 0, kSimulatedTimeRounding_s);
}

TEST(SimulatedTime, GoesOnAsFastAsTheSimulation) {
  SimulatedTime time;
  for (int tick = 0; tick <= 100; ++tick)
    time.tell(kTick_s * tick, kTick_s, at(4 * kTick_s * tick));  // four times slower
  EXPECT_NEAR(time.at(at(4)), 1, kSimulatedTimeRounding_s);
  EXPECT_NEAR(time.at(at(4 + kTick_s / 2)), 1 + kTick_s / 2, kSimulatedTimeRounding_s);
  EXPECT_NEAR(time.at(at(60)), 1 + kTick_s, kSimulatedTimeRounding_s);
}

TEST(SimulatedTime, StandsWhilePaused) {
  SimulatedTime time;
  time.tell(1, kTick_s, at(0));
  const double paused_s = time.at(at(0.02));
  for (int i = 1; i < 100; ++i) {
    time.tell(1, kTick_s, at(0.02 * i));
    EXPECT_NEAR(time.at(at(0.02 * i + 0.001)), paused_s, kSimulatedTimeRounding_s);
  }
}

TEST(SimulatedTime, NeverGoesBackNorJumpsAtAReset) {
  SimulatedTime time;
  time.tell(7, kTick_s, at(0));
  time.tell(8, kTick_s, at(1));
  const double before_s = time.at(at(1));
  time.tell(0, kTick_s, at(1 + kTick_s));
  EXPECT_NEAR(time.at(at(1 + kTick_s)), before_s + kTick_s, kSimulatedTimeRounding_s);
  time.tell(kTick_s, kTick_s, at(1 + 2 * kTick_s));
  EXPECT_NEAR(time.at(at(1 + 2 * kTick_s)), before_s + 2 * kTick_s, kSimulatedTimeRounding_s);
}

TEST(Slowness, IsReportedAfterTwoReadingsAndAgainOnlyAfterItHasKeptUp) {
  Slowness slowness;
  std::string reports;
  for (const char reading : std::string("ssssfsssfffssfss")) reports += slowness.record(reading == 's') ? '!' : '.';
  EXPECT_EQ(reports, ".!..........!...");
}

TEST(Relaunch, KnowsTheRunOfRoslaunchByTheFolderOfItsLog) {
  const std::array<const char*, 3> argv = {"simulator", "__name:=simulator",
                                           "__log:=/var/log/ros/0a1b2c3d-1111-2222-3333-444455556666/simulator-1.log"};
  const Relaunch launched(3, argv.data());
  EXPECT_EQ(launched.runId(), "0a1b2c3d-1111-2222-3333-444455556666");
  EXPECT_FALSE(launched.hasParameters());
  const std::array<const char*, 3> by_hand = {"simulator", "__log:=/tmp/simulator.log", "_scene:=heart"};
  EXPECT_EQ(Relaunch(3, by_hand.data()).runId(), "");
  EXPECT_TRUE(Relaunch(3, by_hand.data()).hasParameters());
}

}  // namespace
}  // namespace viscera::nodes
