// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/model/fitted_scene.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/temporary_folder.h"
#include "viscera/math/error.h"
#include "viscera/model/model.h"

namespace viscera {
namespace {

using test::TemporaryFolder;

constexpr double kRounding = 2e-6;  // of a value: keys are written with six digits

/// Block of 0.1 m, fixed in its top fifth, on a floor.
constexpr const char* kScene =
    "bodies: [{name: block, source: box, box_size_m: [0.1, 0.1, 0.1], spacing_m: 0.01,\n"
    "  fixed: [{shape: plane, point_m: [0, 0, 0.03], normal: [0, 0, -1]},\n"
    "          {shape: box, min_m: [-0.05, -0.05, 0.04], max_m: [0, 0.05, 0.05]}]}]\n"
    "styluses: [{name: left}, {name: right, cut: {blade_length_m: 0.03}}]\n"
    "cameras: [{name: eye, position_m: [0, -0.3, 0.1], target_m: [0, 0, 0.01]}]\n"
    "obstacles:\n"
    "  - {name: floor, shape: plane, position_m: [0, 0, -0.06]}\n";

/// Returns a mesh file of a box around the origin.
std::string boxMesh(const Vector3d& size_m) {
  std::string out;
  for (int c = 0; c < 8; ++c) {
    out += "v";
    for (int axis = 0; axis < 3; ++axis) out += " " + std::to_string((c >> axis & 1 ? 0.5 : -0.5) * size_m[axis]);
    out += "\n";
  }
  return out + "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n";
}

void expectNear(const Vector3d& is, const Vector3d& wanted) {
  EXPECT_LT((is - wanted).norm(), kRounding * std::max(1.0, wanted.norm()))
      << is.transpose() << " instead of " << wanted.transpose();
}

size_t heldNodes(const Body& body) {
  const std::vector<uint32_t>& slots = body.lattice.active_slots;
  return static_cast<size_t>(
      std::count_if(slots.begin(), slots.end(), [&](uint32_t slot) { return isFixed(body.lattice.nodes[slot]); }));
}

class Fit : public ::testing::Test {
 protected:
  FittedScene fitted(const Vector3d& size_m, const Overrides& own = {}) const {
    return loadFittedScene(scene_, meshOverrides(folder_.write("organ.obj", boxMesh(size_m))), own);
  }
  TemporaryFolder folder_;
  std::string scene_ = folder_.write("block.yaml", kScene);
};

TEST_F(Fit, PositionsFollowFromBoxToBoxAndToolsTheSmallerStretch) {
  const Scene scene = fitted({0.2, 0.3, 0.05}).scene;
  ASSERT_TRUE(scene.fit);
  expectNear(scene.fit->stretch, {2, 3, 0.5});
  expectNear(scene.bodies[0].fixed[0].point_m, {0, 0, 0.015});
  expectNear(scene.bodies[0].fixed[0].normal, {0, 0, -1});
  expectNear(scene.bodies[0].fixed[1].min_m, {-0.1, -0.15, 0.02});
  expectNear(scene.bodies[0].fixed[1].max_m, {0, 0.15, 0.025});
  expectNear(scene.obstacles[0].position_m, {0, 0, -0.03});
  EXPECT_NEAR(scene.fit->tool_scale, 0.5, kRounding);  // of x and z: the camera looks along y
  EXPECT_NEAR(scene.styluses[0].clip.jaw_length_m, 0.5 * 0.012, kRounding);
  EXPECT_NEAR(scene.styluses[1].cut.blade_length_m, 0.015, kRounding);
  EXPECT_NEAR(scene.bodies[0].spacing_m, 0.01 * std::cbrt(3.0), kRounding);
  EXPECT_GE(scene.fit->view_scale, 3);
  expectNear(scene.cameras[0].position_m, scene.fit->view_scale * Vector3d(0, -0.3, 0.1));
  expectNear(scene.cameras[0].target_m, scene.fit->view_scale * Vector3d(0, 0, 0.01));
}

TEST_F(Fit, OrgansOfAnySizeAreHeldWithoutAWord) {
  for (const double size_m : {0.004, 0.01, 0.05, 0.1, 0.2, 1.0}) {
    SCOPED_TRACE(size_m);
    const Model model = buildModel(fitted(Vector3d(1, 0.7, 0.8) * size_m).scene);
    const std::vector<std::string>& notes = model.bodies[0].notes;
    EXPECT_NE(notes.back().find("fitted to the organ's box"), std::string::npos) << notes.back();
  }
}

TEST_F(Fit, ReachesThatMeetNodesAreNoSmallerBesideTheCells) {
  const auto ratio = [](const Scene& scene) { return scene.styluses[0].probe.radius_m / scene.bodies[0].spacing_m; };
  const double was = ratio(loadScene(scene_));
  for (const Vector3d& size_m : {Vector3d(0.2, 0.3, 0.05), Vector3d(0.1, 0.1, 0.002), Vector3d(0.05, 0.05, 0.05)})
    EXPECT_NEAR(ratio(fitted(size_m).scene), was, 10 * kRounding) << size_m.transpose();
  EXPECT_NEAR(ratio(fitted(Vector3d::Constant(0.1), {"bodies[0].spacing_m=0.02"}).scene), was, 10 * kRounding);
  EXPECT_NEAR(fitted(Vector3d::Constant(0.1), {"bodies[0].spacing_m=0.005"}).scene.styluses[0].grab.radius_m, 0.008,
              kRounding);
}

TEST_F(Fit, ToolsAreNoSmallerThanTheirKeysAccept) {
  const Scene scene = fitted({0.01, 0.006, 0.0025}).scene;  // a fortieth of the scene's block
  ASSERT_TRUE(scene.fit);
  EXPECT_EQ(scene.styluses[0].cautery.radius_m, 1e-4);
  EXPECT_NEAR(scene.styluses[0].cut_particles.eraser_radius_m, 0.002 / 40, kRounding);
}

TEST_F(Fit, ShaftsShrinkWithSmallOrgansAndDoNotGrowWithLargeOnes) {
  EXPECT_NEAR(fitted(Vector3d::Constant(0.04)).scene.styluses[0].shaft_length_m, 0.4 * 0.12, kRounding);
  EXPECT_NEAR(fitted(Vector3d::Constant(0.3)).scene.styluses[0].shaft_length_m, 0.12, kRounding);
  EXPECT_NEAR(fitted(Vector3d::Constant(0.04), {"styluses[0].shaft_length_m=0.1"}).scene.styluses[0].shaft_length_m,
              0.1, kRounding);
}

TEST_F(Fit, NorAreObstacles) {
  const std::string rod =
      folder_.write("rod.yaml", std::string(kScene) +
                                    "  - {name: rod, shape: capsule, radius_m: 0.001, position_m: [0, 0, -0.06]}\n");
  const std::string organ = folder_.write("organ.obj", boxMesh(Vector3d::Constant(0.004)));
  const Scene scene = loadFittedScene(rod, meshOverrides(organ), {}).scene;
  ASSERT_TRUE(scene.fit);
  EXPECT_EQ(scene.obstacles[1].radius_m, 1e-4);
}

TEST_F(Fit, AThinPlateIsHeldByItsTop) {
  const Scene scene = fitted({0.1, 0.1, 0.0015}).scene;
  ASSERT_TRUE(scene.fit);
  const Model model = buildModel(scene);
  EXPECT_GT(heldNodes(model.bodies[0]), 0U);
}

TEST_F(Fit, WhatIsNotFilledDoesNotCount) {
  // A sheet that encloses nothing, 0.1 m high, on a box of 0.05 m.
  const std::string box = boxMesh(Vector3d::Constant(0.05));
  const std::string sheet = "o fin\nv -0.02 0 0.02\nv 0.02 0 0.02\nv 0.02 0 0.12\nv -0.02 0 0.12\nf 9 10 11 12\n";
  const Scene scene = loadFittedScene(scene_, meshOverrides(folder_.write("fin.obj", "o box\n" + box + sheet)),
                                      {"bodies[0].centered=false"})
                          .scene;
  ASSERT_TRUE(scene.fit);
  expectNear(scene.fit->to_m.max(), Vector3d::Constant(0.025));
  expectNear(scene.bodies[0].fixed[0].point_m, {0, 0, 0.015});
  const Model model = buildModel(scene);
  EXPECT_GT(heldNodes(model.bodies[0]), 0U);
  EXPECT_LT(2 * heldNodes(model.bodies[0]), model.bodies[0].lattice.active_slots.size());
}

TEST_F(Fit, WhatIsSetGoesBefore) {
  const Overrides own = {"bodies[0].fixed[0].point_m=[0, 0, 0.001]", "cameras[0].target_m=[0, 0, 7]",
                         "bodies[0].spacing_m=0.003", "styluses[0].probe.radius_m=0.009",
                         "styluses[1].cut.blade_length_m=0.04"};
  const Scene scene = fitted(Vector3d::Constant(0.05), own).scene;
  EXPECT_EQ(scene.bodies[0].fixed[0].point_m, Vector3d(0, 0, 0.001));
  EXPECT_EQ(scene.cameras[0].target_m, Vector3d(0, 0, 7));
  EXPECT_EQ(scene.bodies[0].spacing_m, 0.003);
  EXPECT_EQ(scene.styluses[0].probe.radius_m, 0.009);
  EXPECT_EQ(scene.styluses[1].cut.blade_length_m, 0.04);
  EXPECT_TRUE(fitted(Vector3d::Constant(0.05), {"bodies[0].fixed=[]", "cameras=[]"}).scene.cameras.empty());
}

TEST_F(Fit, UnitsAndTurnsCountBeforeTheBoxIsTaken) {
  // Rotated by 90 degrees about x: the upright axis is along y. The top is fixed all the same.
  const Scene scene =
      fitted({100, 200, 50}, {"bodies[0].unit_scale_m=0.001", "bodies[0].rotation_deg=[90, 0, 0]"}).scene;
  ASSERT_TRUE(scene.fit);
  expectNear(scene.fit->stretch, {1, 0.5, 2});
  expectNear(scene.bodies[0].fixed[0].point_m, {0, 0.06, 0});  // z 0.06 of the tissue frame is y of the body
  expectNear(scene.bodies[0].fixed[0].normal, {0, -1, 0});
}

TEST_F(Fit, NothingFollowsWithoutAMeshOrAnOrganOutOfAllProportion) {
  EXPECT_FALSE(loadFittedScene(scene_, {}, {"bodies[0].spacing_m=0.02"}).scene.fit);
  EXPECT_TRUE(loadFittedScene(scene_, {}, {}).overrides.empty());
  EXPECT_FALSE(fitted(Vector3d::Constant(100), {"bodies[0].unit_scale_m=1"}).scene.fit);
  EXPECT_FALSE(fitted({0.1, 0.1, 0}).scene.fit);
  EXPECT_FALSE(loadFittedScene(scene_, meshOverrides(folder_.file("none.obj")), {}).scene.fit);
}

TEST_F(Fit, WhatIsNotFilledIsNoPartOfTheBox) {
  const std::string box = boxMesh(Vector3d(0.1, 0.08, 0.06));
  const std::string fin = "o fin\nv 0 -0.04 0.03\nv 0 0.04 0.03\nv 0 0 0.2\nf 9 10 11\n";
  const std::string crumb =  // of 1 mm, 0.3 m to the side
      "o crumb\nv 0.3 0 0\nv 0.301 0 0\nv 0.3 0.001 0\nv 0.3 0 0.001\nf -4 -2 -3\nf -4 -3 -1\nf -4 -1 -2\nf -3 -2 -1\n";
  for (const std::string& more : {fin, crumb, fin + crumb}) {
    const FittedScene scene = loadFittedScene(scene_, meshOverrides(folder_.write("more.obj", box + more)), {});
    ASSERT_TRUE(scene.scene.fit);
    expectNear(scene.scene.fit->to_m.sizes(), {0.1, 0.08, 0.06});
    EXPECT_NO_THROW(buildModel(scene.scene)) << "it is held from above";
  }
}

TEST_F(Fit, ToolsOfTheSmallestOrgansAreAsSmallAsToolsCanBe) {
  const Scene scene = fitted({0.004, 0.003, 0.0025}).scene;
  EXPECT_EQ(scene.styluses[0].cautery.radius_m, 1e-4);
  EXPECT_NO_THROW(buildModel(scene));
}

TEST_F(Fit, AMeshInAnotherUnitIsAskedForIt) {
  const auto question = [&](const Vector3d& size_m) -> std::string {
    try {
      fitted(size_m);
    } catch (const MeshError& error) {
      return error.what();
    }
    return "accepted";
  };
  for (const auto& [width, parts] : std::vector<std::pair<double, std::vector<std::string>>>{
           {100, {"organ.obj", "100 m wide", "unit_scale_m=0.001 (millimetres)?", "bodies[0].unit_scale_m=1"}},
           {3.937, {"3.937 m wide", "unit_scale_m=0.0254 (inches) or 0.01 (centimetres)?"}},
           {12, {"12 m wide", "unit_scale_m=0.01 (centimetres)"}}}) {
    const std::string said = question({0.6 * width, width, 0.4 * width});
    for (const std::string& part : parts) EXPECT_NE(said.find(part), std::string::npos) << said;
  }
  EXPECT_TRUE(fitted(Vector3d::Constant(1.9)).scene.fit) << "a whole body is no mistake";
}

TEST_F(Fit, OfSeveralBodiesTheHeldRegionAloneFollows) {
  const std::string two = std::string(kScene).replace(std::string(kScene).find("}]}]"), 4, "}]}, {name: other}]");
  const std::string path = folder_.write("two.yaml", two);
  const Scene scene =
      loadFittedScene(path, meshOverrides(folder_.write("o.obj", boxMesh(Vector3d::Constant(0.05)))), {}).scene;
  EXPECT_FALSE(scene.fit);
  expectNear(scene.bodies[0].fixed[0].point_m, {0, 0, 0.015});
  EXPECT_EQ(scene.cameras[0].position_m, Vector3d(0, -0.3, 0.1));
}

TEST_F(Fit, ASceneFileOfItIsTheSameScene) {
  const FittedScene was = fitted({0.05, 0.06, 0.07}, {"bodies[0].spacing_m=0.004"});
  const TemporaryFolder elsewhere;
  const Scene is = loadScene(elsewhere.write("scene.yaml", sceneYaml(scene_, was.overrides, "made by a test")));
  EXPECT_EQ(is.bodies[0].mesh_file, folder_.file("organ.obj"));
  EXPECT_EQ(is.bodies[0].fixed[0].point_m, was.scene.bodies[0].fixed[0].point_m);
  EXPECT_EQ(is.cameras[0].position_m, was.scene.cameras[0].position_m);
  EXPECT_EQ(is.styluses[1].cut.blade_length_m, was.scene.styluses[1].cut.blade_length_m);
  EXPECT_EQ(is.bodies[0].spacing_m, 0.004);
}

}  // namespace
}  // namespace viscera
