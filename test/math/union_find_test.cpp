// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "math/union_find.h"

#include <gtest/gtest.h>

#include <random>

namespace viscera {
namespace {

TEST(UnionFind, SetsAreRepresentedByTheirSmallestMembers) {
  UnionFind sets(5);
  EXPECT_EQ(sets.unite(4, 2), 2u);
  EXPECT_EQ(sets.unite(3, 4), 2u);
  EXPECT_EQ(sets.unite(3, 2), 2u) << "they are one set already";
  EXPECT_EQ(sets.add(), 5u);
  EXPECT_EQ(sets.unite(5, 1), 1u);
  EXPECT_EQ(sets.find(5), 1u);
  EXPECT_EQ(sets.size(), 6u);
  EXPECT_EQ(std::move(sets).all(), (std::vector<uint32_t>{0, 1, 2, 2, 2, 1}));
}

/// Against labels that each union renames one by one.
TEST(UnionFind, AgreesWithRelabellingOnRandomUnions) {
  constexpr uint32_t kMembers = 200;
  std::mt19937 random(7);
  UnionFind sets(kMembers);
  std::vector<uint32_t> labels(kMembers);
  std::iota(labels.begin(), labels.end(), 0u);
  for (uint32_t n = 0; n < kMembers; ++n) {
    const auto a = static_cast<uint32_t>(random() % kMembers), b = static_cast<uint32_t>(random() % kMembers);
    const auto [low, high] = std::minmax({labels[a], labels[b]});
    std::replace(labels.begin(), labels.end(), high, low);
    ASSERT_EQ(sets.unite(a, b), low);
    ASSERT_EQ(sets.find(b), low);
  }
  EXPECT_EQ(std::move(sets).all(), labels);
}

}  // namespace
}  // namespace viscera
