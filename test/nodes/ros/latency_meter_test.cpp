// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/ros/latency_meter.h"

#include <gtest/gtest.h>

namespace viscera::nodes {
namespace {

using std::chrono::milliseconds;
constexpr double kRounding_s = 1e-12;
constexpr SteadyTime kBegin{std::chrono::seconds(100)};

TEST(LatencyMeter, ReadingIsOfThePosesSinceTheLastOne) {
  LatencyMeter meter;
  meter.add(kBegin, kBegin + milliseconds(2));
  meter.add(kBegin + milliseconds(10), kBegin + milliseconds(16));
  const LatencyMeter::Reading reading = meter.take().reading();
  EXPECT_NEAR(reading.mean_s, 0.004, kRounding_s);
  EXPECT_NEAR(reading.max_s, 0.006, kRounding_s);
  EXPECT_EQ(meter.take().reading().mean_s, 0);
  EXPECT_EQ(meter.take().reading().max_s, 0);
}

TEST(LatencyMeter, PoseCountsOnceWithItsFirstAnswer) {
  LatencyMeter meter;
  meter.add(kBegin, kBegin + milliseconds(2));
  meter.add(kBegin, kBegin + milliseconds(50));
  EXPECT_NEAR(meter.take().reading().max_s, 0.002, kRounding_s);
  meter.add(kBegin, kBegin + milliseconds(90));
  EXPECT_EQ(meter.take().reading().max_s, 0);
}

TEST(LatencyMeter, WhatWasTakenIsReadWithoutTheMeter) {
  LatencyMeter meter;
  for (int i = 1; i <= 100; ++i)
    meter.add(kBegin + milliseconds(10 * i), kBegin + milliseconds(10 * i + (i * 37) % 101));
  const LatencyMeter taken = meter.take();
  meter.add(kBegin + milliseconds(2000), kBegin + milliseconds(2900));
  EXPECT_FLOAT_EQ(static_cast<float>(taken.reading().p50_s), 0.05F);
  EXPECT_FLOAT_EQ(static_cast<float>(taken.reading().p99_s), 0.099F);
  EXPECT_NEAR(taken.reading().max_s, 0.1, kRounding_s);
}

TEST(LatencyMeter, WithoutAPoseNothingCounts) {
  LatencyMeter meter;
  meter.add(SteadyTime{}, kBegin);
  EXPECT_EQ(meter.take().reading().max_s, 0);
}

}  // namespace
}  // namespace viscera::nodes
