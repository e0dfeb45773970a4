// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// A slit in a held sheet gapes by 4 sigma a / E sqrt(1 - x^2 / a^2); `viscera bench blade` measures more of it.
#include "bench/suites/blade/prestress_slit.h"

#include <gtest/gtest.h>

#include <cmath>

namespace viscera::bench {
namespace {

constexpr double kOpening = 0.05;  // share of the law's opening: the limit of the issue
constexpr double kUncut = 1e-3;    // share of the opening

void expectLaw(const SlitTrial& trial) {
  const SlitResult result = openSlit(trial);
  EXPECT_NEAR(result.opening[0], 1, kOpening);
  EXPECT_NEAR(result.opening[1], 1, kOpening);
  EXPECT_LT(result.uncut, kUncut);
  EXPECT_EQ(result.trips, 0);
}

TEST(PrestressSlit, OfTrianglesOpensByTheLaw) {
  SlitTrial trial;
  trial.spacing_m = trial.half_m / 12.5;
  expectLaw(trial);
}

TEST(PrestressSlit, OfALatticeOpensByTheLaw) {
  SlitTrial trial;
  trial.structure = Structure::kLattice;
  trial.spacing_m = trial.half_m / 6.5;
  trial.radius = 4;
  trial.thickness_m = trial.spacing_m;
  expectLaw(trial);
}

}  // namespace
}  // namespace viscera::bench
