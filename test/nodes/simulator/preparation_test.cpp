// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/simulator/preparation.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "viscera/session/session.h"

namespace viscera::nodes {
namespace {

/// Returns the progress while a session is created with two bodies, one of them with automatic spacing.
std::vector<int> percentsOf(const Scene& scene) {
  Preparation preparation(scene);
  std::vector<int> out;
  const Session session(
      scene, [&](const std::string& stage, double fraction) { out.push_back(preparation.percentAt(stage, fraction)); });
  return out;
}

Scene sceneOf(const std::string& spacing) {
  return parseScene("bodies: [{name: heart, source: phantom, spacing_m: " + spacing +
                        ", skin_spacing_m: 0.004}, {name: block, source: box, spacing_m: 0.01}]",
                    "two");
}

TEST(Preparation, GoesUpFromNothingToNearlyAllInManySteps) {
  for (const char* spacing : {"0.008", "auto"}) {
    const std::vector<int> percents = percentsOf(sceneOf(spacing));
    ASSERT_FALSE(percents.empty());
    EXPECT_LE(percents.front(), 2) << spacing;
    EXPECT_GE(percents.back(), 55) << spacing;  // the last stage begins, and reports nothing further
    EXPECT_LE(percents.back(), 99) << spacing;
    for (size_t i = 1; i < percents.size(); ++i) EXPECT_GE(percents[i], percents[i - 1]) << spacing << ", " << i;
    for (size_t i = 1; i < percents.size(); ++i) EXPECT_LE(percents[i] - percents[i - 1], 35) << spacing << ", " << i;
  }
}

TEST(Preparation, IsNeverLessThanBefore) {
  Preparation preparation(sceneOf("0.008"));
  const int later = preparation.percentAt("heart: bind skin", 1);
  EXPECT_GE(preparation.percentAt("heart: voxelise", 0.5), later);
  EXPECT_GE(preparation.percentAt("a stage of another version", 0), later);
  EXPECT_LE(preparation.percentAt("prepare pictures", 1), 99);
}

}  // namespace
}  // namespace viscera::nodes
