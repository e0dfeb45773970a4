// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Jaws of tools: closing by buttons and devices, grip, and slip.
#include "viscera/tools/jaws.h"

#include <gtest/gtest.h>

#include "model/scene/tool_kinds.h"
#include "viscera/tools/tools.h"

namespace viscera {
namespace {

constexpr double kOpen_rad = 40 * M_PI / 180, kTick_s = 0.02;
constexpr double kTight = 1e-6;  // rad and m: precision of a float for an angle below 1

StylusConfig grasper() {
  StylusConfig config;
  config.idle = ToolMode::kProbe;
  config.button1 = ToolMode::kGrasper;
  config.jaw_closing_s = 0.1;  // five ticks
  config.grasper.max_force_n = 2;
  return config;
}

Tools toolsOf(const StylusConfig& config) {
  ToolLimits limits;
  limits.tick_s = kTick_s;
  return Tools({config}, limits);
}

StylusSamples at(bool button, double jaw_rad = kNoJaw, double z_m = 0) {
  StylusSamples out;
  out[0] = {true, {Vector3d(0, 0, z_m), Quaterniond::Identity()}, button, false, static_cast<float>(jaw_rad)};
  return out;
}

FeelTissue tissueOf(double meets_rad) {
  return [meets_rad](size_t, const StylusMotion&, double) { return Between{meets_rad, 0.01}; };
}

TEST(Jaws, AButtonClosesThemInTheirTimeAndTheyOpenWhenItIsLetGo) {
  StylusConfig config = grasper();
  config.button1 = ToolMode::kGrab;
  Tools tools = toolsOf(config);
  tools.advance(at(false));
  double before_rad = 0.44;
  for (int t = 1; t <= 5; ++t) {
    const StylusMotion motion = tools.advance(at(true))[0];
    EXPECT_NEAR(motion.opens_from_rad, before_rad, kTight);
    EXPECT_NEAR(motion.opens_to_rad, 0.44 * (1 - 0.2 * t), kTight);
    before_rad = motion.opens_to_rad;
  }
  EXPECT_EQ(tools.advance(at(true))[0].opens_to_rad, 0);
  tools.advance(at(false));
  EXPECT_NEAR(tools.advance(at(true))[0].opens_from_rad, 0.44, kTight);
}

TEST(Jaws, FollowAStylusThatReportsThemFromItsFirstTickOn) {
  StylusConfig config = grasper();
  config.idle = ToolMode::kGrasper;
  Tools tools = toolsOf(config);
  const StylusMotion first = tools.advance(at(false, 0.3), tissueOf(1))[0];
  EXPECT_NEAR(first.opens_from_rad, 0.3, kTight) << "a hand that appears has closed nothing";
  EXPECT_FALSE(first.hold_begins);
  EXPECT_NEAR(tools.advance(at(false, 0.6), {})[0].opens_to_rad, 0.6, kTight);
  EXPECT_NEAR(tools.advance(at(false, 3), {})[0].opens_to_rad, kOpen_rad, kTight) << "no farther than they open";
}

TEST(Jaws, OfAModeThatBeginsComeFromOpenNoFasterThanAButtonClosesThem) {
  StylusConfig config = grasper();
  config.button1 = ToolMode::kGrab;
  Tools tools = toolsOf(config);
  tools.advance(at(false, 0.6));
  EXPECT_NEAR(tools.advance(at(true, 0.05))[0].opens_to_rad, 0.8 * 0.44, kTight);
  for (int t = 2; t <= 5; ++t) tools.advance(at(true, 0.05));
  EXPECT_NEAR(tools.advance(at(true, 0.05))[0].opens_to_rad, 0.05, kTight);
  EXPECT_NEAR(tools.advance(at(true, 0.01))[0].opens_to_rad, 0.01, kTight) << "then at once";
}

TEST(Jaws, OfAGrasperHoldWhereTheyMeetTissueWhichKeepsThemApart) {
  constexpr double kThick_rad = 0.4;
  Tools tools = toolsOf(grasper());
  tools.advance(at(false));
  int begun = 0;
  for (int t = 1; t <= 8; ++t) {
    const StylusMotion motion = tools.advance(at(true), tissueOf(kThick_rad))[0];
    if (motion.hold_begins) begun = t;
    EXPECT_GE(motion.opens_to_rad, kThick_rad - kTight);
  }
  EXPECT_EQ(begun, 3) << "0.698, 0.558, 0.419, 0.279 rad: in the third tick they pass 0.4";
  EXPECT_TRUE(tools.fingers(0).holds());
  EXPECT_NEAR(tools.fingers(0).moment_nm(Jaws{0.014, kOpen_rad, 0.1}), 0.01, kTight) << "pressed as if flat";
  const StylusMotion ended = tools.advance(at(false), tissueOf(kThick_rad))[0];
  EXPECT_EQ(ended.hold_ended, ToolMode::kGrasper);
  EXPECT_FALSE(tools.fingers(0).holds());
}

TEST(Jaws, OfAGrasperThatCloseOnNothingHoldNothingWhateverComesThen) {
  Tools tools = toolsOf(grasper());
  tools.advance(at(false));
  const FeelTissue nothing = [](size_t, const StylusMotion&, double) { return std::optional<Between>(); };
  for (int t = 1; t <= 8; ++t) EXPECT_FALSE(tools.advance(at(true), nothing)[0].hold_begins);
  for (int t = 1; t <= 8; ++t) EXPECT_FALSE(tools.advance(at(true), tissueOf(0.2))[0].hold_begins);
}

TEST(Jaws, OfAGrasperLetGoWhenAUserOpensThemWiderThanWhatTheyHold) {
  StylusConfig config = grasper();
  config.idle = ToolMode::kGrasper;
  Tools tools = toolsOf(config);
  tools.advance(at(false, 0.6));
  EXPECT_TRUE(tools.advance(at(false, 0.2), tissueOf(0.3))[0].hold_begins);
  const StylusMotion squeezed = tools.advance(at(false, 0.1), tissueOf(0.3))[0];
  EXPECT_NEAR(squeezed.opens_to_rad, 0.3, kTight);
  EXPECT_EQ(tools.advance(at(false, 0.31), tissueOf(0.3))[0].hold_ended, ToolMode::kNone);
  EXPECT_EQ(tools.advance(at(false, 0.35), tissueOf(0.3))[0].hold_ended, ToolMode::kGrasper);
  EXPECT_TRUE(tools.advance(at(false, 0.1), tissueOf(0.3))[0].hold_begins) << "and they close again";
}

/// A tool that is pulled up by 0.1 mm in a tick, with tissue of a given stiffness [N/m] in its jaws.
TEST(Jaws, WhatTheyHoldSlidesSoThatTheForceIsTheRatedOneAndIsLostAtTheirLength) {
  constexpr double kStiffness = 1000, kPerTick_m = 1e-4, kWithin = 0.1;
  Tools tools = toolsOf(grasper());
  tools.advance(at(false));
  double lost_at_m = 0, most_n = 0;
  for (int t = 1; t <= 300 && lost_at_m == 0; ++t) {
    const ToolMotions motions = tools.advance(at(true, kNoJaw, kPerTick_m * t), tissueOf(0.69));
    if (motions[0].hold_ended != ToolMode::kNone) lost_at_m = kPerTick_m * t;
    if (!tools.grips(motions)) continue;
    const Vector3d held_m = tools.ofHeld(motions)[0].to.position_m;
    EXPECT_LE((tools.ofHeld(motions)[0].to.position_m - tools.ofHeld(motions)[0].from.position_m).norm(),
              2 * kPerTick_m);
    const Vector3d force_n(0, 0, -kStiffness * held_m.z());
    most_n = std::max(most_n, force_n.norm());
    if (kPerTick_m * t > 0.004) {
      EXPECT_NEAR(force_n.norm(), 2, kWithin * 2) << t;
    }
    tools.pulled(0, motions[0], force_n);
  }
  EXPECT_LT(most_n, (1 + kWithin) * 2);
  EXPECT_NEAR(lost_at_m, 0.002 + 0.014, 3 * kPerTick_m) << "what stretches at 2 N, and the jaws' length";
  EXPECT_FALSE(tools.advance(at(true, kNoJaw, 0.02), tissueOf(0.69))[0].hold_begins);
}

}  // namespace
}  // namespace viscera
