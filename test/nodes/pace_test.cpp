// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "nodes/pace_meter.h"
#include "nodes/pacer.h"
#include "nodes/throttle.h"

namespace viscera::nodes {
namespace {

using std::chrono::milliseconds;
constexpr double kRounding = 1e-12;

TEST(Pacer, KeepsTheBeatOfALoopThatIsInTime) {
  const Pacer::Time begun{std::chrono::seconds(100)};
  Pacer pacer(0.01);
  pacer.restart(begun);
  EXPECT_EQ(pacer.next(begun + milliseconds(3)), begun + milliseconds(10));
  EXPECT_EQ(pacer.next(begun + milliseconds(14)), begun + milliseconds(20));
}

TEST(Pacer, LetsALateLoopCatchUpByOneTickAtMost) {
  const Pacer::Time begun{std::chrono::seconds(100)};
  Pacer pacer(0.01);
  pacer.restart(begun);
  const Pacer::Time late = begun + milliseconds(1000);
  EXPECT_EQ(pacer.next(late), late - milliseconds(10));
  EXPECT_EQ(pacer.next(late), late);
  EXPECT_EQ(pacer.next(late), late + milliseconds(10));
}

TEST(Throttle, PicksEveryTickWhereTheRateIsHigher) {
  Throttle throttle(100, 60);
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(throttle.pick());
}

TEST(Throttle, PicksEvenlyWhereTheRateIsLower) {
  for (const double rate_hz : {30.0, 20.0, 7.0}) {
    Throttle throttle(rate_hz, 60);
    EXPECT_TRUE(throttle.pick());
    int picked = 0;
    for (int i = 0; i < 600; ++i) picked += throttle.pick();
    EXPECT_EQ(picked, 10 * rate_hz);
  }
}

TEST(PaceMeter, ReadingIsOfTheTicksSinceTheLastOne) {
  PaceMeter meter;
  meter.add(0.01, 0.002, 0.02);
  meter.add(0.01, 0.004, 0.02);
  const PaceMeter::Reading reading = meter.take();
  EXPECT_NEAR(reading.step_mean_s, 0.003, kRounding);
  EXPECT_NEAR(reading.step_max_s, 0.004, kRounding);
  EXPECT_NEAR(reading.real_time_factor, 0.5, kRounding);
  EXPECT_EQ(meter.take().real_time_factor, 0);
}

}  // namespace
}  // namespace viscera::nodes
