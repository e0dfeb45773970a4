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
  body.material.stiffness_damping_ratio = 0;
  const FeatureSet features = featuresOf(body);
  for (const char* name : {"DASHPOT", "PREDICTED", "LAW", "NO_SPRINGS", "PARTS", "COMPENSATED"})
    EXPECT_FALSE(has(features, name)) << name;
  EXPECT_TRUE(has(features, "SINGLE_BODY"));
}

TEST(Features, SpringsArePredictedWhereTheyHaveDashpotsAndThereAreSome) {
  Body body = test::boxBody({1, 1, 1}, 0.01);
  body.material.stiffness_damping_ratio = 0.2;
  body.material.law = Law::kSprings;
  EXPECT_TRUE(has(featuresOf(body), "PREDICTED"));
  body.material.law = Law::kNeoHookean;
  EXPECT_FALSE(has(featuresOf(body), "PREDICTED"));
}

TEST(Features, LawIsThereWhereABodyObeysOneAndSpringsAreNotWhereAllDo) {
  const Body springs = test::boxBody({1, 1, 1}, 0.01);
  for (const double nu : {0.0, 0.25, 0.49}) {
    const FeatureSet features = featuresOf(test::ofLaw(springs, nu));
    EXPECT_TRUE(has(features, "LAW")) << nu;
    EXPECT_TRUE(has(features, "NO_SPRINGS")) << nu;
  }
  EXPECT_FALSE(has(featuresOf(springs), "LAW"));
  const FeatureSet both = featuresOf(test::modelOf({springs, test::ofLaw(springs)}), Scene{}, 1e-3);
  EXPECT_TRUE(has(both, "LAW"));
  EXPECT_FALSE(has(both, "NO_SPRINGS"));
}

TEST(Features, PartsAreThereWhereStrengthsDifferWithinABody) {
  Body body = test::boxBody({1, 1, 1}, 0.01);
  EXPECT_FALSE(has(featuresOf(body), "PARTS"));
  body.parts = {PartConfig{}};
  EXPECT_TRUE(has(featuresOf(body), "PARTS"));
}

TEST(Features, CompensationComesWithShortSubstepsOrWhenAskedFor) {
  const Body body = test::boxBody({1, 1, 1}, 0.01);
  EXPECT_TRUE(has(featuresOf(body, {}, 49e-6), "COMPENSATED"));
  EXPECT_FALSE(has(featuresOf(body, {}, 51e-6), "COMPENSATED"));
  SolverConfig asked;
  asked.compensated = true;
  EXPECT_TRUE(has(featuresOf(body, asked), "COMPENSATED"));
  asked.integrator = Integrator::kPd;  // does not use compensated sums
  EXPECT_FALSE(has(featuresOf(body, asked), "COMPENSATED"));
}

}  // namespace
}  // namespace viscera
