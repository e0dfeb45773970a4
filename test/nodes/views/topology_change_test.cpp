// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/views/topology_change.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

namespace viscera::nodes {
namespace {

std::vector<uint32_t> triangles(size_t count) {
  std::vector<uint32_t> out(3 * count);
  std::iota(out.begin(), out.end(), 0U);
  return out;
}

TEST(TopologyChange, NothingChangesNothing) {
  const TriangleEdits edits = editsBetween(triangles(50), triangles(50));
  EXPECT_TRUE(edits.kept.empty());
  EXPECT_EQ(edited(triangles(50), edits), triangles(50));
}

TEST(TopologyChange, OneTriangleInPiecesIsOnePosition) {
  const std::vector<uint32_t> before = triangles(1000);
  std::vector<uint32_t> after = before;
  after.erase(after.begin() + 300, after.begin() + 303);
  const std::vector<uint32_t> pieces = {5000, 5001, 5002, 5001, 5002, 5003};
  after.insert(after.begin() + 300, pieces.begin(), pieces.end());
  const TriangleEdits edits = editsBetween(before, after);
  EXPECT_EQ(edits.kept, std::vector<uint32_t>{100});
  EXPECT_EQ(edits.removed, std::vector<uint32_t>{1});
  EXPECT_EQ(edits.added, std::vector<uint32_t>{2});
  EXPECT_EQ(edits.triangles, pieces);
  EXPECT_EQ(edited(before, edits), after);
}

TEST(TopologyChange, AWideCutDoesNotSendWhatFollowsIt) {
  const std::vector<uint32_t> before = triangles(100000);
  std::vector<uint32_t> after(before.begin(), before.begin() + 3 * 40000);
  constexpr size_t kNew = 500;  // more than the search distance
  for (uint32_t i = 0; i < 3 * kNew; ++i) after.push_back(1000000 + i);
  after.insert(after.end(), before.begin() + 3 * 40300, before.end());
  const TriangleEdits edits = editsBetween(before, after);
  EXPECT_EQ(edits.triangles.size(), 3 * kNew);
  EXPECT_EQ(edited(before, edits), after);
}

TEST(TopologyChange, AnyTwoListsAreBroughtTogether) {
  std::mt19937 random(7);
  const auto list = [&](size_t most) {
    std::vector<uint32_t> out;
    for (size_t n = random() % most; n > 0; --n) {
      const uint32_t triangle = random() % 40;  // many are equal, out of order
      for (uint32_t i = 0; i < 3; ++i) out.push_back(3 * triangle + i);
    }
    return out;
  };
  for (int round = 0; round < 500; ++round) {
    const std::vector<uint32_t> before = list(300), after = list(300);
    ASSERT_EQ(edited(before, editsBetween(before, after)), after) << round;
  }
}

}  // namespace
}  // namespace viscera::nodes
