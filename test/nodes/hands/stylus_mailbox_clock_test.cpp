// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Stamps by a device's clock, which is not ours: delays show, the clock's drift does not.
#include <gtest/gtest.h>

#include <random>

#include "nodes/hands/mailbox_poses.h"
#include "nodes/hands/stylus_mailbox.h"

namespace viscera::nodes {
namespace {

constexpr double kHour_s = 3600;

TEST(StylusClock, PoseThatWasLongOnItsWayIsDroppedWhateverTheClockOfTheDevice) {
  StylusMailbox mailbox(config(), "tissue");
  constexpr double kAhead_s = 1e6;  // the device's clock
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
  message.stamp = ros::Time(4294967295u, 0);  // 136 years: more than a ros::Duration holds
  EXPECT_EQ(mailbox.put(message, nowhere, arrival(0)), std::nullopt);
  EXPECT_EQ(mailbox.put(poseNow(1), nowhere, arrival(1)), std::nullopt);
}

/// A device whose clock goes wrong by a share of time, on a way that takes 1 .. 31 ms.
struct DriftingDevice {
  double rate_hz, drift;
  double ahead_s = 1e9;  // as that of a clock that was not set
  StylusMailbox mailbox{config(), "tissue"};
  std::mt19937 random{7};
  std::uniform_real_distribution<double> way_s{0.001, 0.031};

  /// Told at time_s, by our clock. @param late_s  more than its way takes
  std::optional<Drop> tell(double time_s, double late_s = 0) {
    DevicePose pose = poseAt(0.1);
    pose.stamp = ros::Time(ahead_s + (1 + drift) * time_s);
    return mailbox.put(pose, nowhere, arrival(time_s + way_s(random) + late_s));
  }
  /// @returns how many poses were dropped
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
    const double end_s = 6 * kHour_s;  // and a delay shows as before
    EXPECT_EQ(device.tell(end_s, 0.3), Drop::kDelayed) << drift;
    EXPECT_EQ(device.tell(end_s + 0.4), std::nullopt) << drift;
  }
}

TEST(StylusClock, OfAQuickDeviceIsFollowedThoughStampsAreCoarse) {
  DriftingDevice device{8000, -200e-6};  // 25 ns from pose to pose, less than a double of 1e9 s resolves
  device.way_s = std::uniform_real_distribution<double>(1e-5, 3e-5);
  EXPECT_EQ(device.play(0, 120), 0u);
  EXPECT_EQ(device.tell(120, 0.19), std::nullopt);  // 24 ms of drift are no delay
  EXPECT_EQ(device.tell(120.5, 0.21), Drop::kDelayed);
}

/// A driver that works through its device's poses more slowly than they come.
TEST(StylusClock, AQueueThatGrowsIsRefused) {
  for (double growth : {0.1, 0.01, 0.001}) {
    DriftingDevice device{100, 0};
    double refused_s = 0;
    for (double t = 0; t < kHour_s && refused_s == 0; t += 0.01)
      if (device.tell(t, growth * t) == Drop::kDelayed) refused_s = t;
    ASSERT_GT(refused_s, 0) << growth;
    // The least delay creeps up by half of the slowest growth; the way alone differs by 30 ms.
    const double delay_s = growth * refused_s;
    EXPECT_GT(delay_s, config().stale_after_s - 0.031) << growth;
    EXPECT_LT(delay_s, 2.1 * config().stale_after_s) << growth;
  }
}

}  // namespace
}  // namespace viscera::nodes
