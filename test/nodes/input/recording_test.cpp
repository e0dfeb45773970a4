// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "nodes/input/stylus_record.h"
#include "support/text.h"

namespace viscera::nodes {
namespace {

using Outcome = Recording::Outcome;
using test::says;

Samples tick(uint64_t number, bool input_reset = false) {
  Samples message;
  message.tick = number;
  message.tick_hz = 100;
  message.input_reset = input_reset;
  message.scene = "heart";
  message.overrides = "solver.tick_hz=100";
  message.styluses.emplace_back().stylus = "left";
  message.styluses[0].pose.position.x = 0.1 * static_cast<double>(number);
  message.styluses[0].pose.orientation.w = 1;
  return message;
}

TEST(Recording, BeginsWithTheFirstTick) {
  Recording recording;
  EXPECT_EQ(recording.add(tick(7)), Outcome::kWaiting);
  EXPECT_EQ(recording.ticks(), 0u);
  EXPECT_EQ(recording.add(tick(1, true)), Outcome::kTaken);
  EXPECT_EQ(recording.add(tick(2)), Outcome::kTaken);
  EXPECT_EQ(recording.strokes().input_reset, std::vector<uint64_t>{1});
  EXPECT_EQ(recording.strokes().tick_hz, 100);
  EXPECT_EQ(recording.strokes().recorded.scene, "heart");
  EXPECT_EQ(recording.strokes().recorded.overrides, "solver.tick_hz=100");
  ASSERT_EQ(recording.strokes().strokes.size(), 1u);
  EXPECT_EQ(recording.strokes().strokes[0].samples.at(1).pose.position_m.x(), 0.2);
}

TEST(Recording, AResetBeginsAgain) {
  Recording recording;
  for (const uint64_t number : {1, 2, 3}) recording.add(tick(number));
  EXPECT_EQ(recording.add(tick(1)), Outcome::kAnew);
  EXPECT_EQ(recording.strokes().strokes[0].samples.size(), 1u);
}

TEST(Recording, ALostTickEndsItBeforeTheGap) {
  Recording recording;
  for (const uint64_t number : {1, 2}) recording.add(tick(number));
  EXPECT_EQ(recording.add(tick(5)), Outcome::kEnded);
  EXPECT_TRUE(says(recording.fault(), {"ticks 3 to 4 were lost"}));
  EXPECT_EQ(recording.add(tick(6)), Outcome::kEnded);
  EXPECT_EQ(recording.ticks(), 2u);
}

TEST(Recording, WhatStrokesCannotSayEndsIt) {
  Recording recording;
  recording.add(tick(1));
  Samples carried = tick(2);
  carried.besides = "obstacle 'tile', which follows tf";
  EXPECT_EQ(recording.add(carried), Outcome::kEnded);
  EXPECT_TRUE(says(recording.fault(), {"cannot contain", "'tile'"}));
}

TEST(Recording, AnHourIsTheMost) {
  Recording recording;
  Samples message = tick(1);
  message.tick_hz = 1e-3;  // so that the hour is 3.6 ticks
  for (message.tick = 1; message.tick <= 3; ++message.tick) EXPECT_EQ(recording.add(message), Outcome::kTaken);
  EXPECT_EQ(recording.add(message), Outcome::kEnded);
  EXPECT_TRUE(says(recording.fault(), {"one hour"}));
}

}  // namespace
}  // namespace viscera::nodes
