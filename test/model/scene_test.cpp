// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "viscera/model/scene/scene.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "support/temporary_folder.h"
#include "support/text.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

using test::says;

/// Returns the reader's error for a scene.
std::string sceneRefusal(const std::string& yaml, const Overrides& overrides = {}) {
  return test::messageOf<SceneError>([&] { parseScene(yaml, "s.yaml", overrides); });
}

/// Scene, and what its error must contain.
struct Case {
  std::string yaml;
  std::vector<std::string> parts;
};

void expectRefusals(const std::vector<Case>& cases) {
  for (const Case& c : cases) EXPECT_TRUE(says(sceneRefusal(c.yaml), c.parts)) << c.yaml;
}

TEST(Scene, PartIsLikeTheMaterialOfItsBodyButForWhatItSays) {
  const Scene scene = parseScene(
      "bodies: [{parts: [{part: valve, young_modulus_pa: 9}], material: {young_modulus_pa: 7, poisson_ratio: 0.4, "
      "density_kg_per_m3: 900}}]\n",
      "s.yaml");
  const PartConfig& part = scene.bodies.at(0).parts.at(0);
  EXPECT_EQ(part.young_modulus_pa, 9);
  EXPECT_EQ(part.poisson_ratio, 0.4);
  EXPECT_EQ(part.density_kg_per_m3, 900);
}

TEST(Scene, UnknownKeyIsRefusedWithFileLineKeyAndTheAcceptedKeys) {
  expectRefusals({
      {"bodies: [{}]\nbodeis: 1\n", {"s.yaml:2: ", "unknown key 'bodeis'", "bodies, name, look, styluses"}},
      {"bodies:\n  - name: a\n    material:\n      young: 3\n",
       {"s.yaml:4: ", "unknown key 'bodies[0].material.young'", "young_modulus_pa, poisson_ratio, density_kg_per_m3"}},
      {"bodies:\n  - name: a\n  - name: b\n    spacing: 1\n",
       {"s.yaml:4: ", "unknown key 'bodies[1].spacing'", "spacing_m"}},
      {"bodies:\n  - fixed:\n      - shape: box\n      - {shape: box, radius: 1}\n",
       {"s.yaml:4: ", "unknown key 'bodies[0].fixed[1].radius'", "radius_m"}},
      {"bodies: [{}]\nsolver:\n  dt: 1\n", {"s.yaml:3: ", "unknown key 'solver.dt'", "dt_fraction"}},
  });
}

TEST(Scene, WrongTypeIsRefusedWithFileLineKeyAndWhatIsAccepted) {
  expectRefusals({
      {"bodies:\n  - spacing_m: soft\n",
       {"s.yaml:2: 'bodies[0].spacing_m' must be a number, 1e-05 .. 10 m, or auto; found 'soft'"}},
      {"bodies:\n  - spacing_m: [1]\n", {"s.yaml:2: 'bodies[0].spacing_m' must be a number", "found a list of 1"}},
      {"bodies:\n  - spacing_m:\n", {"s.yaml:2: 'bodies[0].spacing_m' must be a number", "found nothing"}},
      {"bodies:\n  - position_m: [0, 1]\n",
       {"s.yaml:2: 'bodies[0].position_m' must be a list of 3 numbers, -10 .. 10 m"}},
      {"bodies:\n  - position_m: [0, 1, up]\n", {"s.yaml:2: 'bodies[0].position_m' must be a number", "found 'up'"}},
      {"bodies:\n  - position_m: 3\n", {"s.yaml:2: 'bodies[0].position_m' must be a list of 3 numbers"}},
      {"bodies:\n  - name: [a]\n", {"s.yaml:2: 'bodies[0].name' must be a non-empty string; found a list of 1"}},
      {"bodies:\n  - name: ''\n", {"s.yaml:2: 'bodies[0].name' must be a non-empty string"}},
      {"bodies:\n  - source: fish\n",
       {"s.yaml:2: 'bodies[0].source' must be one of mesh, box, ball, phantom, sheet, tube, labels; found 'fish'"}},
      {"bodies: [{}]\ncameras:\n  - overlays: lattice\n",
       {"s.yaml:3: 'cameras[0].overlays' must be a list of names out of lattice, springs, normals, strain, forces, "
        "wind"}},
      {"bodies: [{}]\ncameras:\n  - overlays: [latice]\n",
       {"s.yaml:3: 'cameras[0].overlays': unknown overlay 'latice'; accepted: lattice, forces, wind"}},
      {"bodies:\n  - target_nodes: 10.5\n", {"s.yaml:2: 'bodies[0].target_nodes' must be a whole number, 0 .. 2e+07"}},
      {"bodies:\n  material: soft\n", {"s.yaml:2: 'bodies' must be a list of at most 16 items; found a map"}},
      {"bodies:\n  - material: soft\n", {"s.yaml:2: 'bodies[0].material' must be a map of keys, not 'soft'"}},
      {"bodies:\n  - heart\n", {"s.yaml:2: 'bodies[0]' must be a map of keys, not 'heart'"}},
  });
}

TEST(Scene, SubstepThatTheDashpotMakesUnstableIsRefusedWithTheOneThatWouldDo) {
  expectRefusals({
      {"bodies: [{}]\nsolver: {dt_fraction: 0.9}\n",
       {"s.yaml: ", "solver.dt_fraction = 0.9", "it must be less than 0.81980"}},
      {"bodies: [{}, {name: b, material: {stiffness_damping_ratio: 0.5}}]\nsolver: {dt_fraction: 0.7}\n",
       {"body 'b'", "0.618"}},
  });
  EXPECT_NO_THROW(
      parseScene("bodies: [{material: {stiffness_damping_ratio: 0}}]\nsolver: {dt_fraction: 0.9}\n", "s.yaml"));
}

TEST(Scene, MeshOverridesTurnGltfUpright) {
  EXPECT_EQ(meshOverrides("/a/HEART.GLB").back(), "bodies[0].up_axis=y");
  EXPECT_EQ(meshOverrides("/a/heart.obj").back(), "bodies[0].up_axis=z");
  EXPECT_TRUE(meshOverrides("").empty());
}

TEST(Scene, ValueOutOfRangeIsRefusedWithFileLineKeyAndRange) {
  expectRefusals({
      {"bodies:\n  - material:\n      young_modulus_pa: -20000\n",
       {"s.yaml:3: 'bodies[0].material.young_modulus_pa' must be a number, 1 .. 1e+09 Pa; found '-20000'"}},
      {"bodies:\n  - material: {density_kg_per_m3: 0}\n", {"s.yaml:2: ", "1 .. 100000 kg/m3; found '0'"}},
      {"bodies:\n  - material: {stiffness_damping_ratio: 0.6}\n",
       {"s.yaml:2: ", "'bodies[0].material.stiffness_damping_ratio'", "0 .. 0.5"}},
      {"bodies:\n  - position_m: [0, 0, 11]\n", {"s.yaml:2: ", "'bodies[0].position_m'", "-10 .. 10 m; found '11'"}},
      {"bodies: [{}]\ncameras:\n  - width_px: 5000\n", {"s.yaml:3: ", "'cameras[0].width_px'", "16 .. 4096"}},
      {"bodies: [{}]\nsolver: {tick_hz: 0}\n", {"s.yaml:2: ", "'solver.tick_hz'", "1 .. 1000 Hz"}},
      {"bodies: [{}]\nstyluses: [{name: a}, {name: b}, {name: c}]\n", {"s.yaml:2: ", "'styluses'", "at most 2"}},
  });
}

TEST(Scene, NumberThatIsNotFiniteIsRefused) {
  for (const char* number : {".nan", ".NaN", ".inf", "-.inf", "1e999", "nan", "inf"}) {
    const std::string text = number;
    EXPECT_TRUE(says(sceneRefusal("bodies:\n  - spacing_m: " + text + "\n"), {"s.yaml:2: ", "1e-05 .. 10 m", text}));
    EXPECT_TRUE(
        says(sceneRefusal("bodies:\n  - position_m: [0, " + text + ", 0]\n"), {"s.yaml:2: ", "position_m", text}));
  }
}

TEST(Scene, KeyGivenTwiceIsRefused) {
  expectRefusals({
      {"name: a\nbodies: [{}]\nname: b\n", {"s.yaml:3: ", "key 'name' is given twice"}},
      {"bodies:\n  - spacing_m: 0.01\n    spacing_m: 0.02\n",
       {"s.yaml:3: ", "key 'bodies[0].spacing_m' is given twice"}},
  });
}

TEST(Scene, FileThatIsNoMapOfKeysIsRefused) {
  for (const char* yaml : {"", "# nothing but this\n", "heart\n", "- a\n- b\n", "---\n"}) {
    EXPECT_TRUE(says(sceneRefusal(yaml), {"s.yaml", "map of keys", "bodies"})) << yaml;
  }
}

TEST(Scene, BrokenYamlIsRefusedWithFileAndLine) {
  expectRefusals({{"name: a\nbodies: [\n", {"s.yaml:3: "}},
                  {"name: a\nbodies: [{}]\n  x: : y\n", {"s.yaml:3: "}},
                  {"name: a\nbodies: *nothing\n", {"s.yaml:2: ", "anchor"}}});
}

TEST(Scene, NestingWithoutEndIsRefused) {
  EXPECT_TRUE(says(sceneRefusal("name: " + std::string(200000, '[')), {"s.yaml"}));
}

TEST(Scene, FileThatCannotBeReadIsNamed) {
  const test::TemporaryFolder folder;
  const auto loading = [](const std::string& path) { return test::messageOf<SceneError>([&] { loadScene(path); }); };
  EXPECT_TRUE(says(loading(folder.file("none.yaml")), {folder.file("none.yaml"), "cannot be read"}));
  EXPECT_TRUE(says(loading(folder.path()), {folder.path(), "is a folder"}));
  EXPECT_TRUE(says(loading(folder.write("empty.yaml", "")), {folder.file("empty.yaml"), "bodies"}));
}

TEST(Scene, NeedsABody) {
  EXPECT_TRUE(says(sceneRefusal("name: a\n"), {"s.yaml", "'bodies' must contain at least one body"}));
  EXPECT_TRUE(says(sceneRefusal("bodies: []\n"), {"s.yaml", "'bodies' must contain at least one body"}));
}

TEST(Scene, NamesMustBeUniqueAndFitForTopics) {
  expectRefusals({
      {"bodies: [{}, {}]\n", {"name 'tissue' is used twice in 'bodies'"}},
      {"bodies: [{}]\nstyluses: [{name: left}, {name: left}]\n", {"name 'left' is used twice in 'styluses'"}},
      {"bodies: [{}]\ncameras: [{name: eye}, {name: eye}]\n", {"name 'eye' is used twice in 'cameras'"}},
      {"bodies: [{}]\ncameras: [{name: my eye}]\n", {"name 'my eye' in 'cameras'", "letters, digits and _"}},
      {"bodies: [{}]\nstyluses: [{name: ../left}]\n", {"name '../left' in 'styluses'"}},
      {"bodies: [{name: 1st}]\n", {"name '1st' in 'bodies'", "must start with a letter"}},
  });
}

TEST(Scene, KeysThatOnlyTogetherMakeNoSenseAreRefusedByName) {
  expectRefusals({
      {"bodies: [{name: a, source: mesh}]\n", {"s.yaml", "body 'a'", "needs 'mesh_file'"}},
      {"bodies: [{name: a, fixed: [{min_m: [1, 0, 0]}]}]\n", {"body 'a' fixed[0]", "'min_m'", "'max_m'"}},
      {"bodies: [{name: a, fixed: [{shape: plane, normal: [0, 0, 0]}]}]\n", {"body 'a' fixed[0]", "'normal'"}},
      {"bodies: [{name: a, fixed: [{}, {shape: part}]}]\n", {"body 'a' fixed[1]", "'part'"}},
      {"bodies: [{name: a, fixed: [{part: rim}]}]\n", {"body 'a' fixed[0]", "'part'", "'shape: part'"}},
  });
}

TEST(Scene, CameraWithoutALineOfSightIsRefusedByName) {
  for (const char* camera : {"position_m: [1, 2, 3], target_m: [1, 2, 3]",  // looks nowhere
                             "position_m: [0, 0, 1], target_m: [0, 0, 0]",  // looks down, up is z
                             "position_m: [0, 1, 0], up: [0, 0, 0]"}) {     // no up
    const std::string yaml = "bodies: [{}]\ncameras: [{name: eye, " + std::string(camera) + "}]\n";
    EXPECT_TRUE(says(sceneRefusal(yaml), {"s.yaml", "camera 'eye'", "line of sight"})) << yaml;
  }
}

TEST(Scene, ACameraIsOnOneStylusThatTheSceneHasOrOnAFrame) {
  const std::string left = "bodies: [{}]\nstyluses: [{name: left}]\ncameras: [{name: eye, ";
  EXPECT_EQ(parseScene(left + "stylus: left}]\n", "s").cameras[0].stylus, "left");
  expectRefusals({
      {left + "stylus: right}]\n", {"camera 'eye'", "'stylus' must be the name of a stylus", "found 'right'"}},
      {left + "stylus: left, frame: arm}]\n", {"camera 'eye'", "'stylus' and 'frame' exclude each other"}},
      {left + "lens_angle_deg: 30}]\n", {"camera 'eye'", "'lens_angle_deg' needs 'stylus'"}},
  });
}

TEST(Scene, ALensThatShowsOnePositionTwiceIsRefusedByName) {
  const std::string eye = "bodies: [{}]\ncameras: [{name: eye, vertical_fov_deg: 90, distortion: {";
  EXPECT_TRUE(
      says(sceneRefusal(eye + "k1: -0.4}}]\n"), {"s.yaml", "camera 'eye'", "'distortion'", "2.5 times", "row 0"}));
  EXPECT_TRUE(says(sceneRefusal(eye + "k1: 11}}]\n"), {"s.yaml:2: ", "'cameras[0].distortion.k1'", "-10 .. 10"}));
  EXPECT_EQ(parseScene(eye + "k1: 0.1}}]\n", "s").cameras[0].distortion.k1, 0.1);
}

TEST(Scene, WhatIsLeftOutHasItsDefault) {
  const Scene scene =
      parseScene("bodies:\n  - {spacing_m: 0.01, material: {mass_damping_per_s: 9}}\n  - {name: b}\n", "s");
  ASSERT_EQ(scene.bodies.size(), 2u);
  EXPECT_EQ(scene.bodies[0].spacing_m, 0.01);
  EXPECT_EQ(scene.bodies[0].material.mass_damping_per_s, 9);
  EXPECT_EQ(scene.bodies[0].material.young_modulus_pa, MaterialConfig{}.young_modulus_pa);
  EXPECT_EQ(scene.bodies[1].spacing_m, BodyConfig{}.spacing_m);  // not that of the previous body
  EXPECT_EQ(scene.bodies[1].material.mass_damping_per_s, MaterialConfig{}.mass_damping_per_s);
  EXPECT_TRUE(scene.styluses.empty());
  EXPECT_TRUE(scene.cameras.empty());
  EXPECT_EQ(scene.environment.gravity_m_per_s2, EnvironmentConfig{}.gravity_m_per_s2);
  EXPECT_EQ(scene.solver.tick_hz, SolverConfig{}.tick_hz);
}

TEST(Scene, BothEndsOfARangeAreAccepted) {
  EXPECT_EQ(sceneRefusal("bodies: [{spacing_m: 1e-5}, {name: b, spacing_m: 10}]\n"), "nothing was thrown");
  EXPECT_NE(sceneRefusal("bodies: [{spacing_m: 0.99e-5}]\n"), "nothing was thrown");
  EXPECT_NE(sceneRefusal("bodies: [{spacing_m: 10.01}]\n"), "nothing was thrown");
}

TEST(Scene, KnowsTheFolderOfItsFile) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(loadScene(folder.write("a.yaml", "bodies: [{}]\n")).folder, folder.path());
}

TEST(Scene, IsLoadedByTheNameThatItIsShippedBy) {
  const Scene scene = loadScene("heart", {"solver.tick_hz=500"});
  EXPECT_EQ(scene.solver.tick_hz, 500);
  EXPECT_EQ(std::filesystem::path(scene.file).filename(), "heart.yaml");
  EXPECT_TRUE(std::filesystem::exists(scene.file));
  EXPECT_THROW(loadScene("hart"), SceneError);
  EXPECT_THROW(loadScene("./heart"), SceneError) << "a file is meant";
}

}  // namespace
}  // namespace viscera
