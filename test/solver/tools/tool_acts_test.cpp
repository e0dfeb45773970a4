// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/contact/tool_acts.h"

#include <gtest/gtest.h>

namespace viscera {
namespace {

struct Asked : ToolPort {
  int cuts = 0;
  void takeHold(uint32_t, const Pose&, double) override {}
  void letGo(uint32_t, const Release&) override {}
  void cut(uint32_t, bool) override { ++cuts; }
};

TEST(ToolActs, AskForCutsWhereBladesMayMeetSomethingOnly) {
  constexpr double kTick_s = 0.01, kOpen_rad = 0.5;
  const ToolActs acts(std::vector<StylusConfig>(1), kTick_s);
  const auto cuts = [&](ToolMode mode, double from_rad, double to_rad) {
    ToolMotions motions;
    motions[0].present = true;
    motions[0].mode = mode;
    motions[0].opens_from_rad = from_rad;
    motions[0].opens_to_rad = to_rad;
    Asked asked;
    acts.beforeSubstep(asked, motions);
    EXPECT_EQ(acts.sever(motions), asked.cuts > 0);
    return asked.cuts;
  };
  EXPECT_EQ(cuts(ToolMode::kProbe, 0, 0), 0);
  EXPECT_EQ(cuts(ToolMode::kCut, 0, 0), 1);
  EXPECT_EQ(cuts(ToolMode::kScissors, kOpen_rad, 0), 1);
  EXPECT_EQ(cuts(ToolMode::kScissors, 0, 0), 0);
  EXPECT_EQ(cuts(ToolMode::kScissors, kOpen_rad, kOpen_rad), 0);
  EXPECT_EQ(cuts(ToolMode::kScissors, 0, kOpen_rad), 0) << "as they open";
}

}  // namespace
}  // namespace viscera
