// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/tissue/fields.h"

#include <gtest/gtest.h>

using namespace viscera;

TEST(Fields, LongestVectorAndLargestComponentAreThoseOfAnySlot) {
  const Field field = {{1, -2, 2}, {0, 0, -2.5}, {0, 0, 0}};
  EXPECT_DOUBLE_EQ(largestNorm(field), 3);
  EXPECT_DOUBLE_EQ(largestComponent(field), 2.5);
}

TEST(Fields, OfNoSlotsAreZero) {
  EXPECT_EQ(largestNorm({}), 0);
  EXPECT_EQ(largestComponent({}), 0);
}
