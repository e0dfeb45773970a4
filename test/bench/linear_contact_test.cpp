// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/specimens/linear_contact.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bench/harness/specimens/block.h"

namespace viscera::bench {
namespace {

double overHertz(int cells, double spacing_m, double radius_m, double depth_m, Surroundings surroundings) {
  const MaterialConfig material = unitMaterial();
  const LinearContact block(cells, spacing_m, material, surroundings, 2 * std::sqrt(radius_m * depth_m) + spacing_m);
  return block.press(radius_m, depth_m).force_n / hertzForce(material, radius_m, depth_m);
}

// Radius of the contact 3 spacings: 0.5 % of error is the spacing's (docs/material.md).
TEST(LinearContact, AHalfSpaceIsTheSameWhateverTheSizeOfTheBlock) {
  const double small = overHertz(7, 1, 24, 0.375, Surroundings::kHalfSpace);
  EXPECT_NEAR(small, overHertz(10, 1, 24, 0.375, Surroundings::kHalfSpace), 1e-3);
  EXPECT_NEAR(small, 1, 0.01);
}

TEST(LinearContact, ABondedBlockIsStifferThanAHalfSpaceAndLessSoTheThickerItIs) {
  const double thin = overHertz(5, 1, 16, 0.25, Surroundings::kBonded),
               thick = overHertz(8, 1, 16, 0.25, Surroundings::kBonded);
  EXPECT_GT(thick, 1.1);
  EXPECT_GT(thin, thick + 0.1);
}

TEST(LinearContact, ForceOverHertzDoesNotDependOnTheUnitOfLength) {
  EXPECT_NEAR(overHertz(6, 1e-3, 16e-3, 0.25e-3, Surroundings::kHalfSpace),
              overHertz(6, 1, 16, 0.25, Surroundings::kHalfSpace), 2e-7);  // spring constants are float32's
}

TEST(LinearContact, ASphereThatDoesNotReachTheSurfaceFeelsNothing) {
  const LinearContact block(4, 1, unitMaterial(), Surroundings::kHalfSpace, 2);
  EXPECT_EQ(block.press(10, -0.1).force_n, 0);
  EXPECT_EQ(block.press(10, -0.1).touched, 0);
}

}  // namespace
}  // namespace viscera::bench
