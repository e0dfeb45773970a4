// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scene/tool_kinds.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

namespace viscera {
namespace {

TEST(ToolKinds, EveryKindHasAModeANameAndAColourOfItsOwn) {
  std::set<std::string> names;
  std::set<std::array<uint8_t, 3>> colors;
  for (const ToolKind& kind : kToolKinds) {
    EXPECT_EQ(&kindOf(kind.mode), &kind);
    EXPECT_TRUE(names.insert(kind.name).second) << kind.name;
    EXPECT_TRUE(colors.insert(kind.color).second) << kind.name;
  }
}

TEST(ToolKinds, WhatDoesNothingReachesNothing) {
  const ToolKind& none = kindOf(ToolMode::kNone);
  EXPECT_EQ(none.effects, 0u);
  EXPECT_FALSE(none.touches() || none.severs());
  EXPECT_EQ(none.reach_m(StylusConfig()), 0);
}

TEST(ToolKinds, EachKindReachesAsFarAsItsOwnKeySays) {
  StylusConfig stylus;
  stylus.probe.radius_m = 0.011;
  stylus.grab.radius_m = 0.022;
  stylus.cut_particles.eraser_radius_m = 0.003;
  stylus.suction.radius_m = 0.004;
  EXPECT_EQ(kindOf(ToolMode::kProbe).reach_m(stylus), 0.011);
  EXPECT_EQ(kindOf(ToolMode::kGrab).reach_m(stylus), 0.022);
  EXPECT_EQ(kindOf(ToolMode::kCutParticles).reach_m(stylus), 0.003);
  EXPECT_EQ(kindOf(ToolMode::kSuction).reach_m(stylus), 0.004);
  EXPECT_EQ(kindOf(ToolMode::kNeedle).reach_m(stylus), 0.022);
}

TEST(ToolKinds, SuctionAndGraspersLetGoAboveAForce) {
  StylusConfig stylus;
  stylus.grasper.max_force_n = 0.8;
  EXPECT_EQ(kindOf(ToolMode::kGrasper).grip(stylus).max_force_n, 0.8);
  stylus.suction.max_force_n = 0.7;
  EXPECT_EQ(kindOf(ToolMode::kSuction).grip(stylus).max_force_n, 0.7);
  EXPECT_TRUE(std::isinf(kindOf(ToolMode::kGrab).grip(stylus).max_force_n));
}

TEST(ToolKinds, AKindThatTouchesIsNotOneThatSevers) {
  for (const ToolKind& kind : kToolKinds) EXPECT_FALSE(kind.touches() && kind.severs()) << kind.name;
}

}  // namespace
}  // namespace viscera
