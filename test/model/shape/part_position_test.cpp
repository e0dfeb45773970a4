// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/model/part_position.h"

#include <gtest/gtest.h>

#include "support/text.h"
#include "viscera/math/error.h"
#include "viscera/model/model.h"
#include "viscera/model/scene/scene.h"

namespace viscera {
namespace {

constexpr double kSpacing_m = 0.004;
/// A position is the mean of nodes within a spacing on either side; at an end of the part, on one side alone.
constexpr double kAtEnd_m = 1.5 * kSpacing_m;

const Model& gallbladderModel() {
  static const Model model = buildModel([] {
    Scene scene;
    BodyConfig body;
    body.phantom = Anatomy::kGallbladder;
    body.phantom_length_m = 0.08;
    body.spacing_m = kSpacing_m;
    body.skin_spacing_m = kSpacing_m;
    scene.bodies = {body};
    return scene;
  }());
  return model;
}

double distance_m(const PartPosition& position, const Vector3d& expected_m) {
  return (positionOf(gallbladderModel(), position) - expected_m).norm();
}

TEST(PartPosition, FollowsAPartFromItsNeighbour) {
  // Ends of the axes in src/model/shape/organ/gallbladder.cpp.
  EXPECT_LT(distance_m({"cystic_duct", "infundibulum", 0}, {0.013, -0.010, -0.0255}), kAtEnd_m);
  EXPECT_LT(distance_m({"cystic_duct", "infundibulum", 0.5}, {0.022, -0.0087, -0.034}), kSpacing_m);
  EXPECT_LT(distance_m({"cystic_duct", "infundibulum", 1}, {0.029, -0.007, -0.041}), kAtEnd_m);
  EXPECT_LT(distance_m({"cystic_duct", "common_bile_duct", 0}, {0.029, -0.007, -0.041}), kAtEnd_m);
  EXPECT_LT(distance_m({"cystic_artery", "hepatic_artery", 0}, {0.0205, -0.004, -0.0125}), kAtEnd_m);
}

TEST(PartPosition, IsTheMiddleWithoutAStartAndAddsItsOffset) {
  const PartPosition middle{"gallbladder", "", 0.2};
  EXPECT_LT(distance_m(middle, {-0.009, -0.010, 0.012}), 2 * kSpacing_m);
  PartPosition beside = middle;
  beside.offset_m = {0.01, 0.02, 0.03};
  EXPECT_NEAR(
      (positionOf(gallbladderModel(), beside) - positionOf(gallbladderModel(), middle) - beside.offset_m).norm(), 0,
      1e-12);
}

TEST(PartPosition, RefusesUnknownPartsByName) {
  const auto refusal = [](const PartPosition& position) {
    return test::messageOf<Error>([&] { positionOf(gallbladderModel(), position); });
  };
  EXPECT_TRUE(test::says(refusal({"spleen", ""}), {"cystic_duct", "liver", "found 'spleen'"}));
  EXPECT_TRUE(test::says(refusal({"liver", "spleen"}), {"found 'spleen'"}));
}

}  // namespace
}  // namespace viscera
