// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/specimens/linear_contact.h"

#include <gtest/gtest.h>

#include <cmath>

#include "bench/harness/specimens/block.h"

namespace viscera::bench {
namespace {

double overHertz(int cells, double spacing_m, double radius_m, double depth_m, FarField far_field) {
  const MaterialConfig material = unitMaterial();
  const LinearContact block(cells, spacing_m, material, far_field, 2 * std::sqrt(radius_m * depth_m) + spacing_m);
  return block.press(radius_m, depth_m).force_n / hertzForce(material, radius_m, depth_m);
}

// Radius of the contact 3 spacings: 0.5 % of the error is due to the spacing (docs/verification.md).
TEST(LinearContact, AHalfSpaceIsTheSameWhateverTheSizeOfTheBlock) {
  const double small = overHertz(7, 1, 24, 0.375, FarField::kHalfSpace);
  EXPECT_NEAR(small, overHertz(10, 1, 24, 0.375, FarField::kHalfSpace), 1e-3);
  EXPECT_NEAR(small, 1, 0.01);
}

TEST(LinearContact, ABondedBlockIsStifferThanAHalfSpaceAndLessSoTheThickerItIs) {
  const double thin = overHertz(5, 1, 16, 0.25, FarField::kBonded),
               thick = overHertz(8, 1, 16, 0.25, FarField::kBonded);
  EXPECT_GT(thick, 1.1);
  EXPECT_GT(thin, thick + 0.1);
}

TEST(LinearContact, ForceOverHertzDoesNotDependOnTheUnitOfLength) {
  EXPECT_NEAR(overHertz(6, 1e-3, 16e-3, 0.25e-3, FarField::kHalfSpace), overHertz(6, 1, 16, 0.25, FarField::kHalfSpace),
              2e-7);  // spring constants are float32
}

TEST(LinearContact, ASphereThatDoesNotReachTheSurfaceFeelsNothing) {
  const LinearContact block(4, 1, unitMaterial(), FarField::kHalfSpace, 2);
  EXPECT_EQ(block.press(10, -0.1).force_n, 0);
  EXPECT_EQ(block.press(10, -0.1).touched, 0);
}

}  // namespace
}  // namespace viscera::bench
