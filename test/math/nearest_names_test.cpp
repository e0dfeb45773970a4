// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "math/nearest_names.h"

#include <gtest/gtest.h>

namespace viscera {
namespace {

TEST(NearestNames, ComeFirstAndTheOthersKeepTheirOrder) {
  const std::vector<std::string> names = {"name", "source", "box_size_m", "spacing_m", "target_nodes", "skin_faces"};
  EXPECT_EQ(nearestFirst("spacng_m", names)[0], "spacing_m");
  EXPECT_EQ(nearestFirst("SPACING_M", names)[0], "spacing_m");
  EXPECT_EQ(nearestFirst("nmae", names)[0], "name") << "neighbours exchanged are one mistake";
  const std::vector<std::string> sorted = nearestFirst("target_node", names);
  EXPECT_EQ(sorted[0], "target_nodes");
  EXPECT_EQ(sorted.size(), names.size());
  EXPECT_EQ(nearestFirstText("runn", {"check", "replay", "run", "task"}), "run, task, check, replay");
  EXPECT_EQ(nearestFirstText("x", {}), "");
  EXPECT_EQ(nearestFirst(std::string(100000, 'x'), names).size(), names.size());
}

}  // namespace
}  // namespace viscera
