// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/suture/suture_bodies.h"

#include <gtest/gtest.h>

#include "math/archive.h"
#include "solver/processes/suture/suture_shape.h"
#include "viscera/math/error.h"
#include "viscera/model/scene/scene.h"

namespace viscera {
namespace {

constexpr double kTick_s = 1.0 / 60, kLink = 1e-9;
constexpr double kPosition_m = 1e-5;  // of held or resting nodes

/// Returns a scene with 60 mm of suture above the point x = 0 of the ground.
std::string sceneWith(const std::string& keys, double height_m = 0.01) {
  const std::string height = std::to_string(height_m);
  return "bodies: [{name: block, source: box}]\nstyluses: [{name: hand}]\nsutures:\n  - {name: suture, position_m: "
         "[-0.03, 0, " +
         height + "], path: [{position_m: [0.03, 0, " + height + "]}]" + keys + "}\n";
}

Scene sceneOf(const std::string& yaml) {
  return parseScene(yaml, "test.yaml");
}

ToolMotions grabAt(const Vector3d& from_m, const Vector3d& to_m, bool begins) {
  ToolMotions out;
  out[0].present = true;
  out[0].mode = ToolMode::kGrab;
  out[0].hold_begins = begins;
  out[0].from.position_m = from_m;
  out[0].to.position_m = to_m;
  return out;
}

TEST(SuturePositions, FollowTheirPathInLinksOfOneLengthAndGoOnStraight) {
  SutureConfig config;
  config.spacing_m = 0.001;
  config.length_m = 0.05;
  config.path = {{Vector3d(0, 0, 0)}, {Vector3d(0.0105, 0, 0)}, {Vector3d(0.0105, 0.02, 0)}};
  const std::vector<Vector3d> positions = positionsOf(config);
  ASSERT_EQ(positions.size(), 51U);
  for (size_t i = 1; i < positions.size(); ++i)
    EXPECT_NEAR((positions[i] - positions[i - 1]).norm(), 0.001, kLink) << i;
  EXPECT_LT((positions[10] - Vector3d(0.01, 0, 0)).norm(), kLink);
  for (size_t i = 11; i < positions.size(); ++i) EXPECT_NEAR(positions[i].x(), 0.0105, kLink) << i;
  EXPECT_GT(positions.back().y(), 0.038);
}

TEST(SutureMaterials, AreOfSizeAndMaterialUnlessTheSceneSaysMore) {
  SutureConfig config;
  config.material = SutureMaterial::kSilk;
  config.usp = SutureSize::kUsp4;
  const ChainMaterial silk = materialOf(config);
  EXPECT_DOUBLE_EQ(silk.radius_m, 0.0875e-3);
  config.radius_m = 2 * silk.radius_m;
  EXPECT_NEAR(materialOf(config).bending_nm2, 16 * silk.bending_nm2, 1e-9 * silk.bending_nm2);
  config.radius_m = 0;
  config.bending_share = 1;
  EXPECT_GT(materialOf(config).bending_nm2, 10 * silk.bending_nm2);  // a braid bends easily
}

TEST(SutureScene, NamesWhatIsWrongWithASuture) {
  const auto fault = [](const std::string& yaml) {
    try {
      sceneOf(yaml);
    } catch (const SceneError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(fault(sceneWith("")), "");
  EXPECT_NE(fault("bodies: [{source: box}]\nsutures: [{position_m: [0, 0, 1], path: [{position_m: [0, 0, 1]}]}]\n")
                .find("suture 'suture': 'path'"),
            std::string::npos);
  EXPECT_NE(fault(sceneWith(", spacing_m: 0.1")).find("2 .. 4000"), std::string::npos);
  EXPECT_NE(fault(sceneWith(", radius_m: 1.0e-9")).find("'radius_m' must be 0 or at least"), std::string::npos);
  EXPECT_NE(fault(sceneWith(", density_kg_per_m3: 0.1")).find("'density_kg_per_m3' must be"), std::string::npos);
  EXPECT_NE(fault(sceneWith(", usp: 7-0")).find("sutures[0].usp"), std::string::npos);
}

TEST(SutureBodies, SuturesFallOnATableAndStay) {
  const Scene scene = sceneOf(sceneWith("") + "obstacles: [{name: table, shape: plane}]\n");
  SutureBodies sutures(scene);
  ObstacleMotions still(1);
  for (int k = 0; k < 60; ++k) sutures.step({}, still);
  const double radius_m = sutures.chain(0).material().radius_m;
  for (const Vector3d& position : sutures.chain(0).positions_m()) EXPECT_NEAR(position.z(), radius_m, kPosition_m);
  // and are drawn along by its friction
  for (int k = 0; k < 60; ++k) {
    still[0].from = still[0].to;
    still[0].to.position_m.x() += 0.05 * kTick_s;
    sutures.step({}, still);
  }
  EXPECT_NEAR(sutures.chain(0).positions_m()[0].x(), -0.03 + 0.05, 0.002);
}

TEST(SutureBodies, ToolsThatGrabTakeSuturesAndLetThemGo) {
  const Scene scene = sceneOf(sceneWith(", start: fixed"));
  SutureBodies sutures(scene);
  const Vector3d end_m(0.03, 0, 0.01), offset_m(-0.02, 0.01, 0.01);
  constexpr int kTicks = 30;
  for (int k = 0; k < kTicks; ++k) {
    sutures.step(grabAt(end_m + k * offset_m / kTicks, end_m + (k + 1) * offset_m / kTicks, k == 0), {});
  }
  EXPECT_LT((sutures.chain(0).positions_m().back() - end_m - offset_m).norm(), kPosition_m);
  EXPECT_LT((sutures.chain(0).positions_m()[0] - Vector3d(-0.03, 0, 0.01)).norm(), kPosition_m);
  const Vector3d far_m = end_m + Vector3d(0.05, 0, 0);
  for (int k = 0; k < kTicks; ++k) {  // farther than the suture is long: it slips in the stylus, and does not stretch
    const Vector3d from_m = end_m + offset_m;
    sutures.step(grabAt(from_m + k * (far_m - from_m) / kTicks, from_m + (k + 1) * (far_m - from_m) / kTicks, false),
                 {});
  }
  EXPECT_NEAR(sutures.chain(0).positions_m().back().x(), 0.03, 1e-4);
  EXPECT_NEAR(sutures.chain(0).tension_n(40), scene.styluses[0].max_force_n, 0.06 * scene.styluses[0].max_force_n);
  EXPECT_LT(sutures.chain(0).worstLink(), 1e-3);
  for (int k = 0; k < 60; ++k) sutures.step({}, {});
  EXPECT_LT(sutures.chain(0).positions_m().back().z(), 0);  // hangs, or swings
}

TEST(SutureBodies, AToolOutOfReachTakesNothing) {
  const Scene scene = sceneOf(sceneWith(", start: fixed, end: fixed"));
  SutureBodies sutures(scene), alone(scene);
  const Vector3d above_m(0, 0, 0.01 + 2 * scene.styluses[0].grab.radius_m);
  sutures.step(grabAt(above_m, above_m, true), {});
  alone.step({}, {});
  EXPECT_EQ(hashWith(0, sutures), hashWith(0, alone));
}

TEST(SutureBodies, GoOnFromASavedStateAndReset) {
  const Scene scene = sceneOf(sceneWith(", start: fixed") + "obstacles: [{name: table, shape: plane}]\n");
  const ObstacleMotions still(1);
  SutureBodies one(scene), two(scene);
  const uint64_t first = hashWith(7, one);
  const Vector3d tip_m(0.03, 0, 0.01);
  for (int k = 0; k < 20; ++k) one.step(grabAt(tip_m, tip_m, k == 0), still);
  Archive saved;
  one.persist(saved);
  Archive read(saved.sections());
  two.persist(read);
  read.end();
  for (int k = 0; k < 20; ++k) {
    one.step(grabAt(tip_m, tip_m, false), still);
    two.step(grabAt(tip_m, tip_m, false), still);
  }
  EXPECT_EQ(hashWith(7, one), hashWith(7, two));
  EXPECT_NE(hashWith(7, one), first);
  EXPECT_NE(hashWith(7, one), hashWith(8, one));
  one.reset();
  EXPECT_EQ(hashWith(7, one), first);
}

}  // namespace
}  // namespace viscera
