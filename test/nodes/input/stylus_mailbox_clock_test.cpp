// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Stamps by a device's clock, which differs from ours: delays are detected, clock drift is not.
#include <gtest/gtest.h>

#include <random>

#include "nodes/input/mailbox_poses.h"
#include "nodes/input/stylus_mailbox.h"

namespace viscera::nodes {
namespace {

constexpr double kHour_s = 3600;

TEST(StylusClock, LatePoseIsDroppedForAnyClockOfTheDevice) {
  StylusMailbox mailbox(config(), "tissue");
  constexpr double kAhead_s = 1e6;  // offset of the device's clock
  const auto sent = [](double t) { return poseNow(kAhead_s + t); };
  for (double t = 0; t < 0.5; t += 0.1) EXPECT_EQ(mailbox.put(sent(t), nowhere, arrival(t)), std::nullopt);
  EXPECT_EQ(mailbox.put(sent(0.45), nowhere, arrival(0.75)), Drop::kDelayed);
  EXPECT_EQ(mailbox.put(sent(0.7), nowhere, arrival(0.8)), std::nullopt);
}

TEST(StylusClock, SetBackIsHeard) {
  StylusMailbox mailbox(config(), "tissue");
  mailbox.put(poseNow(50), nowhere, arrival(0));
  EXPECT_EQ(mailbox.put(poseNow(-50), nowhere, arrival(1)), std::nullopt);
}

TEST(StylusClock, StampsFarApartAreNoTrouble) {
  StylusMailbox mailbox(config(), "tissue");
  DevicePose message = poseAt(0.1);
  message.stamp = ros::Time(4294967295u, 0);  // 136 years: more than a ros::Duration can represent
  EXPECT_EQ(mailbox.put(message, nowhere, arrival(0)), std::nullopt);
  EXPECT_EQ(mailbox.put(poseNow(1), nowhere, arrival(1)), std::nullopt);
}

/// A device with a relative clock drift, and a latency of 1 .. 31 ms.
struct DriftingDevice {
  double rate_hz, drift;
  double ahead_s = 1e9;  // like a clock that was not set
  StylusMailbox mailbox{config(), "tissue"};
  std::mt19937 random{7};
  std::uniform_real_distribution<double> delay_s{0.001, 0.031};

  /// Sends a pose at time_s, by our clock. @param late_s  delay in addition to the latency
  std::optional<Drop> tell(double time_s, double late_s = 0) {
    DevicePose pose = poseAt(0.1);
    pose.stamp = ros::Time(ahead_s + (1 + drift) * time_s);
    return mailbox.put(pose, nowhere, arrival(time_s + delay_s(random) + late_s));
  }
  /// Sends poses. @returns number of dropped poses
  size_t play(double from_s, double to_s) {
    size_t dropped = 0;
    for (int64_t i = std::llround(from_s * rate_hz), end = std::llround(to_s * rate_hz); i < end; ++i)
      dropped += tell(static_cast<double>(i) / rate_hz).has_value();
    return dropped;
  }
};

TEST(StylusClock, ThatGoesSlowOrFastIsFollowedForHours) {
  for (double drift : {-200e-6, -50e-6, 50e-6, 200e-6}) {
    DriftingDevice device{20, drift};
    EXPECT_EQ(device.play(0, 6 * kHour_s), 0u) << drift;
    const double end_s = 6 * kHour_s;  // and a delay is still detected
    EXPECT_EQ(device.tell(end_s, 0.3), Drop::kDelayed) << drift;
    EXPECT_EQ(device.tell(end_s + 0.4), std::nullopt) << drift;
  }
}

TEST(StylusClock, OfAQuickDeviceIsFollowedThoughStampsAreCoarse) {
  DriftingDevice device{8000, -200e-6};  // 25 ns from pose to pose, below the resolution of a double at 1e9 s
  device.delay_s = std::uniform_real_distribution<double>(1e-5, 3e-5);
  EXPECT_EQ(device.play(0, 120), 0u);
  EXPECT_EQ(device.tell(120, 0.19), std::nullopt);  // 24 ms of drift are not a delay
  EXPECT_EQ(device.tell(120.5, 0.21), Drop::kDelayed);
}

/// A driver that processes its device's poses more slowly than they arrive.
TEST(StylusClock, AQueueThatGrowsIsRefused) {
  for (double growth : {0.1, 0.01, 0.001}) {
    DriftingDevice device{100, 0};
    double refused_s = 0;
    for (double t = 0; t < kHour_s && refused_s == 0; t += 0.01)
      if (device.tell(t, growth * t) == Drop::kDelayed) refused_s = t;
    ASSERT_GT(refused_s, 0) << growth;
    // The estimated least delay grows at half of the slowest growth; the latency alone varies by 30 ms.
    const double delay_s = growth * refused_s;
    EXPECT_GT(delay_s, config().stale_after_s - 0.031) << growth;
    EXPECT_LT(delay_s, 2.1 * config().stale_after_s) << growth;
  }
}

}  // namespace
}  // namespace viscera::nodes
