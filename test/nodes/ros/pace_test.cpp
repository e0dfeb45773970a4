// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "nodes/ros/pace_meter.h"
#include "nodes/ros/pacer.h"
#include "nodes/ros/throttle.h"
#include "nodes/views/picture_watch.h"

namespace viscera::nodes {
namespace {

using std::chrono::milliseconds;
constexpr double kPaceRounding = 1e-12;

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
  EXPECT_NEAR(reading.step_mean_s, 0.003, kPaceRounding);
  EXPECT_NEAR(reading.step_max_s, 0.004, kPaceRounding);
  EXPECT_NEAR(reading.real_time_factor, 0.5, kPaceRounding);
  EXPECT_EQ(meter.take().real_time_factor, 0);
}

TEST(PictureWatch, NamesTheSlowCameraOnceWithItsNumbers) {
  std::vector<CameraConfig> cameras(2);
  cameras[0].name = "near";
  cameras[1].name = "far";
  PictureWatch watch(cameras);
  for (int second = 1; second < PictureWatch::kReadings; ++second) {
    EXPECT_TRUE(watch.record({30, 30}, {9, 11}).empty());
    EXPECT_TRUE(watch.areBehind());
  }
  const std::vector<std::string> said = watch.record({30, 30}, {9, 11});
  ASSERT_EQ(said.size(), 1u);
  for (const char* word : {"'near'", "9 pictures", "30 wanted", "width_px", "supersampling", "rate_hz", "spacing_m"})
    EXPECT_NE(said[0].find(word), std::string::npos) << word;
  for (int second = 0; second < 3 * PictureWatch::kReadings; ++second)
    EXPECT_TRUE(watch.record({30, 30}, {9, 11}).empty());
}

TEST(PictureWatch, WhoWantsNoneIsNotBehind) {
  PictureWatch watch(std::vector<CameraConfig>(1));
  for (int second = 0; second < 2 * PictureWatch::kReadings; ++second) {
    EXPECT_TRUE(watch.record({0}, {0}).empty());
    EXPECT_FALSE(watch.areBehind());
  }
}

TEST(PictureWatch, SaysHowPixelsAreMade) {
  std::vector<CameraConfig> cameras(3);
  cameras[1].supersampling = 1;
  cameras[2].supersampling = 2;
  const PictureWatch watch(cameras);
  EXPECT_NE(watch.renderPaths(true)[0].find("only one is lit"), std::string::npos);
  EXPECT_EQ(watch.renderPaths(false)[0].find("only one is lit"), std::string::npos);
  EXPECT_NE(watch.renderPaths(true)[1].find("1 sample"), std::string::npos);
  EXPECT_NE(watch.renderPaths(true)[2].find("4 samples each"), std::string::npos);
}

}  // namespace
}  // namespace viscera::nodes
