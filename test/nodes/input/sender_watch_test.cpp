// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/input/sender_watch.h"

#include <gtest/gtest.h>

namespace viscera::nodes {
namespace {

SenderWatch::SteadyTime timeAt(double time_s) {
  static const SenderWatch::SteadyTime start = std::chrono::steady_clock::now();
  return start + std::chrono::duration_cast<SenderWatch::SteadyTime::duration>(std::chrono::duration<double>(time_s));
}

TEST(SenderWatch, NamesNodesThatSendAtTheSameTimeAndSaysSoOnce) {
  SenderWatch watch;
  EXPECT_FALSE(watch.record("/driver", timeAt(0)));
  EXPECT_FALSE(watch.record("/driver", timeAt(0.1)));
  EXPECT_EQ(watch.several(timeAt(0.1)), "");
  EXPECT_TRUE(watch.record("/replay", timeAt(0.2)));
  EXPECT_FALSE(watch.record("/driver", timeAt(0.3)));
  EXPECT_EQ(watch.several(timeAt(0.3)), "/driver, /replay");
  EXPECT_EQ(watch.several(timeAt(5)), "");
}

TEST(SenderWatch, DriverThatTakesOverFromAnotherIsNoTrouble) {
  SenderWatch watch;
  watch.record("/driver_1", timeAt(0));
  EXPECT_FALSE(watch.record("/driver_2", timeAt(2)));
  EXPECT_EQ(watch.several(timeAt(2)), "");
}

}  // namespace
}  // namespace viscera::nodes
