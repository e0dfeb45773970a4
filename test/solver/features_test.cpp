// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/tissue/features.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/lattices.h"
#include "viscera/model/scene/scene.h"

namespace viscera {
namespace {

bool has(const FeatureSet& features, const std::string& name) {
  const std::vector<std::string> defines = features.defines();
  return std::find(defines.begin(), defines.end(), name) != defines.end();
}

FeatureSet featuresOf(const Body& body, const SolverConfig& solver = {}, double dt_s = 1e-3) {
  Scene scene;
  scene.solver = solver;
  return featuresOf(test::modelOf({body}), scene, dt_s, layout::kGroupSize);
}

TEST(Features, PlainSceneAsksForNoneOfThem) {
  Body body = test::boxBody({1, 1, 1}, 0.01);
  body.material.dashpot_ratio = 0;
  const FeatureSet features = featuresOf(body);
  for (const char* name : {"DASHPOT", "PREDICTED", "VOLUME", "PARTS", "COMPENSATED"})
    EXPECT_FALSE(has(features, name)) << name;
  EXPECT_TRUE(has(features, "SINGLE_BODY"));
}

TEST(Features, SpringsArePredictedWhereTheyHaveDashpotsAndNoCellIsByMoments) {
  Body body = test::boxBody({1, 1, 1}, 0.01);
  body.material.dashpot_ratio = 0.2;
  body.material.cells = Cells::kSprings;
  EXPECT_TRUE(has(featuresOf(body), "PREDICTED"));
  body.material.cells = Cells::kMoments;
  EXPECT_FALSE(has(featuresOf(body), "PREDICTED"));
}

TEST(Features, VolumeIsThereForAnyPoissonsRatioButAQuarter) {
  Body body = test::boxBody({1, 1, 1}, 0.01);
  for (double nu : {0.0, 0.2499, 0.2501, 0.49}) {
    body.material.poisson_ratio = nu;
    EXPECT_TRUE(has(featuresOf(body), "VOLUME")) << nu;
  }
  body.material.poisson_ratio = 0.25;
  EXPECT_FALSE(has(featuresOf(body), "VOLUME"));
  PartConfig part;
  part.poisson_ratio = 0.4;
  body.parts = {part};
  EXPECT_TRUE(has(featuresOf(body), "VOLUME"));
  EXPECT_TRUE(has(featuresOf(body), "PARTS"));
}

TEST(Features, CompensationComesWithShortSubstepsOrWhenAskedFor) {
  const Body body = test::boxBody({1, 1, 1}, 0.01);
  EXPECT_TRUE(has(featuresOf(body, {}, 49e-6), "COMPENSATED"));
  EXPECT_FALSE(has(featuresOf(body, {}, 51e-6), "COMPENSATED"));
  SolverConfig asked;
  asked.compensated = true;
  EXPECT_TRUE(has(featuresOf(body, asked), "COMPENSATED"));
  asked.integrator = Integrator::kPd;  // does not sum so
  EXPECT_FALSE(has(featuresOf(body, asked), "COMPENSATED"));
}

}  // namespace
}  // namespace viscera
