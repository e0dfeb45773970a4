// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "cli/small_scene.h"
#include "support/text.h"

namespace viscera {
namespace {

using namespace test;

/// A folder with a valid scene; every test makes one thing invalid.
class BadInput : public ::testing::Test {
 protected:
  /// Expects that the command ends with status 1 and one line that names the fault, and prints no result.
  static void expectRefusal(const std::vector<std::string>& arguments, const std::vector<std::string>& parts,
                            const std::vector<std::string>& environment = {}) {
    const Ending ending = viscera(arguments, environment);
    EXPECT_EQ(ending.status, 1) << ending.err;
    const std::vector<std::string> errors = complaints(ending);
    ASSERT_EQ(errors.size(), 1u) << ending.err;
    EXPECT_EQ(linesOf(ending.err).back(), errors[0]);
    EXPECT_TRUE(says(errors[0], parts));
    EXPECT_EQ(ending.out.find("state_hash"), std::string::npos);
  }
  /// Expects the same of a run of the valid scene with these options.
  void expectRunRefusal(std::vector<std::string> options, const std::vector<std::string>& parts) {
    options.insert(options.begin(), {"run", scene_, "--seconds", "0.05"});
    expectRefusal(options, parts);
  }
  void expectSetRefusal(const std::string& key_value, const std::vector<std::string>& parts) {
    expectRunRefusal({"--set", key_value}, parts);
  }
  /// Returns strokes with one key of a stylus.
  std::string strokes(const std::string& stylus, const std::string& more = "") {
    return folder_.write("strokes.yaml", "strokes:\n  - {stylus: " + stylus + ", keys: [{t_s: 0}]" + more + "}\n");
  }

  TemporaryFolder folder_;
  std::string scene_ = folder_.write("block.yaml", kBlockScene);
};

TEST_F(BadInput, GoodSceneIsNoBadInput) {
  EXPECT_EQ(viscera({"run", scene_, "--seconds", "0.05"}).status, 0);
}

TEST_F(BadInput, SceneThatIsNotThere) {
  expectRefusal({"run", "no_such_scene"}, {"'no_such_scene'", "shipped scene"});
  expectRefusal({"run", folder_.file("none.yaml")}, {folder_.file("none.yaml")});
  expectRefusal({"run", folder_.path()}, {folder_.path(), "folder"});
  expectRefusal({"bench", "speed", "--scene", folder_.file("none.yaml"), "--out", folder_.path()},
                {folder_.file("none.yaml")});
  expectRefusal({"anchor", folder_.file("none.yaml"), "--strokes", strokes("left"), "--out", folder_.file("out.yaml")},
                {folder_.file("none.yaml")});
}

TEST_F(BadInput, KeysAndValuesThatWereRemoved) {
  for (const std::string integrator : {"multigrid", "auto", "verlet_paper"})
    expectRunRefusal({"--set", "solver.integrator=" + integrator},
                     {"'solver.integrator: " + integrator + "' was removed", "use leapfrog"});
  expectRunRefusal({"--set", "bodies[0].structure=tetrahedra"}, {"was removed", "use lattice", "Gmsh"});
  expectRunRefusal({"--set", "solver.spring_forces=edge"}, {"'solver.spring_forces' was removed", "remove it"});
  expectRunRefusal({"--set", "bodies[0].material.cells=moments"}, {"material.cells' was removed", "material.law"});
  for (const std::string key : {"search=grid", "partitions=2", "window=8"})
    expectRunRefusal({"--set", "collision." + key}, {"was removed", "the search for contacts is complete"});
  expectRefusal({"settle", folder_.file("none.yaml")}, {folder_.file("none.yaml")});
}

TEST_F(BadInput, SceneThatIsWrong) {
  expectRefusal({"run", folder_.write("key.yaml", std::string(kBlockScene) + "bodeis: 1\n")},
                {folder_.file("key.yaml") + ":10: ", "'bodeis'"});
  expectRefusal({"run", folder_.write("noise.yaml", std::string("\0\xff\xfe{[\x01\n\xc3(", 10))}, {"noise.yaml"});
  expectRefusal({"run", folder_.write("empty.yaml", "")}, {"empty.yaml"});
}

TEST_F(BadInput, Override) {
  expectSetRefusal("bodies[0].spacing=1", {"override", "'bodies[0].spacing'"});
  expectSetRefusal("bodies[0].spacing_m=-1", {"override", "'bodies[0].spacing_m'", "1e-05 .. 10 m"});
  expectSetRefusal("bodies[0].spacing_m=automatic", {"override", "'bodies[0].spacing_m'", "1e-05 .. 10 m, or auto"});
  expectSetRefusal("solver.real_time_factor=0", {"override", "'solver.real_time_factor'", "0.01 .. 1000"});
  expectSetRefusal("bodies[7].spacing_m=1", {"bodies[7]"});
  expectSetRefusal("nonsense", {"'nonsense'", "key=value"});
}

TEST_F(BadInput, SpacingThatDoesNotFitTheTissue) {
  expectSetRefusal("bodies[0].spacing_m=5", {"'block'", "spacing_m 5", "at most 0.04"});
  expectSetRefusal("bodies[0].spacing_m=1e-5", {"'block'", "spacing_m 1e-05", "GiB", "would fit"});
}

TEST_F(BadInput, SceneThatCannotBeStepped) {
  expectSetRefusal("solver.max_substeps=2", {"solver.max_substeps = 2"});
  expectSetRefusal("bodies[0].fixed=[{shape: part, part: nose}]", {"block.yaml:7", "fixed[0]", "'nose'"});
  expectSetRefusal("bodies[0].fixed=[{shape: sphere, center_m: [1, 1, 1]}]", {"block.yaml:7", "fixed[0]", "no node"});
}

TEST_F(BadInput, MeshFile) {
  const std::string plane = "v 0 0 0\nv 0.1 0 0\nv 0.1 0.1 0\nv 0 0.1 0\nf 1 2 3\nf 1 3 4\n";
  expectRunRefusal({"--mesh", folder_.file("none.obj")}, {folder_.file("none.obj"), "no such file"});
  expectRunRefusal({"--mesh", folder_.path()}, {folder_.path(), "directory"});
  expectRunRefusal({"--mesh", folder_.write("empty.obj", "")}, {"empty.obj", "empty"});
  expectRunRefusal({"--mesh", folder_.write("text.obj", "I am no mesh\n")}, {"text.obj"});
  expectRunRefusal({"--mesh", folder_.write("corrupt.glb", "glTF\2\0\0\0 and then noise")}, {"corrupt.glb"});
  expectRunRefusal({"--mesh", folder_.write("plane.obj", plane)}, {"plane.obj", "volume"});
  expectRunRefusal({"--mesh", folder_.write("inch.obj",
                                            "v 0 0 0\nv 3.937 0 0\nv 0 2.362 0\nv 0 0 1.575\nf 1 3 2\n"
                                            "f 1 2 4\nf 1 4 3\nf 2 3 4\n")},
                   {"inch.obj", "3.937 m wide; should it be unit_scale_m=", "0.0254 (inches)?"});
  expectRunRefusal({"--mesh", folder_.write("nan.obj", "v nan 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n")}, {"nan.obj"});
}

TEST_F(BadInput, MeshFileOfAScene) {
  const std::string text = "bodies: [{name: organ, source: mesh, mesh_file: none.stl}]\n";
  expectRefusal({"run", folder_.write("mesh.yaml", text)}, {folder_.file("none.stl"), "no such file"});
}

TEST_F(BadInput, Strokes) {
  expectRunRefusal({"--strokes", folder_.file("none.yaml")}, {folder_.file("none.yaml")});
  expectRunRefusal({"--strokes", strokes("third_hand")}, {"strokes.yaml", "'third_hand'", "left"});
  expectRunRefusal({"--strokes", strokes("left", ", speed: 3")}, {"strokes.yaml:2: ", "'strokes[0].speed'"});
  expectRunRefusal({"--strokes", strokes("left", ", anchor: {from_m: [5, 5, 5], towards_m: [5, 5, 6]}")},
                   {"strokes.yaml: ", "'left'", "[5, 5, 5]", "no tissue"});
}

TEST_F(BadInput, PositionToWriteTo) {
  expectRunRefusal({"--out", scene_ + "/pictures"}, {scene_ + "/pictures"});
  expectRefusal({"bench", "speed", "--nodes", "8", "--out", scene_ + "/tables"}, {scene_ + "/tables"});
  expectRefusal({"anchor", scene_, "--strokes", strokes("left"), "--out", folder_.file("none/x.yaml")},
                {folder_.file("none/x.yaml")});
}

TEST_F(BadInput, MachineWithoutADevice) {
  expectSetRefusal("solver.device=31", {"EGL", "31"});
  expectRefusal({"check"}, {"EGL"}, {kNoDevice});
  expectRefusal({"run", scene_}, {"EGL", "--no-view"}, {kNoDevice});
  expectRefusal({"run", scene_, "--no-view", "--set", "solver.backend=gpu"}, {"EGL", "solver.backend"}, {kNoDevice});
}

TEST_F(BadInput, CommandLineIsExplainedNotCrashedOn) {
  const std::vector<std::vector<std::string>> wrong = {{},
                                                       {"fly"},
                                                       {"run"},
                                                       {"run", scene_, "--fly"},
                                                       {"run", scene_, "--seconds", "-1"},
                                                       {"run", scene_, "--seconds", "nan"},
                                                       {"bench"},
                                                       {"bench", "reference"},
                                                       {"bench", "speed", "--nodes", "0"},
                                                       {"bench", "speed", "--backend", "fpga"},
                                                       {"bench", "speed", "--threads", "-1"},
                                                       {"bench", "speed", "--set", "name=x"},
                                                       {"bench", "speed", "--only", "everything"},
                                                       {"check", "--device", "x"}};
  for (const auto& arguments : wrong) {
    const Ending ending = viscera(arguments);
    EXPECT_GT(ending.status, 0) << ::testing::PrintToString(arguments);
    EXPECT_FALSE(ending.err.empty()) << ::testing::PrintToString(arguments);
  }
}

}  // namespace
}  // namespace viscera
