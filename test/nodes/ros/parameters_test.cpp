// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/ros/parameters.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "model/scene/file_bounds.h"
#include "nodes/simulated_devices/stylus_replay.h"
#include "nodes/simulator/simulator_options.h"

namespace viscera::nodes {
namespace {

using XmlRpc::XmlRpcValue;

constexpr double kCell_m = 0.005;  // half a cell of the block, the tolerance of its surface

/// Expects that the call fails with a message that contains all of these words.
template <class Call>
void expectRefused(Call call, const std::vector<std::string>& words) {
  try {
    call();
    ADD_FAILURE() << "was accepted";
  } catch (const Error& e) {
    for (const std::string& word : words) EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << e.what();
  }
}

XmlRpcValue one(const std::string& key, const XmlRpcValue& value) {
  XmlRpcValue values;
  values[key] = value;
  return values;
}

TEST(Parameters, AbsentOnesTakeTheDefault) {
  Parameters none{XmlRpcValue()};
  EXPECT_EQ(none.text("scene", "heart"), "heart");
  EXPECT_EQ(none.number("rate_hz", 30, 1, 100), 30);
  EXPECT_TRUE(none.texts("overrides").empty());
  EXPECT_NO_THROW(none.refuseOthers());
}

TEST(Parameters, WholeNumberServesAsANumber) {
  Parameters parameters(one("rate_hz", XmlRpcValue(25)));
  EXPECT_EQ(parameters.number("rate_hz", 30, 1, 100), 25);
}

TEST(Parameters, IdentifiersAreStringsOrIntegers) {
  EXPECT_EQ(Parameters(one("grip", XmlRpcValue("04BA"))).identifier("grip", "any"), "04BA");
  EXPECT_EQ(Parameters(one("grip", XmlRpcValue(61548))).identifier("grip", "any"), "61548");
  EXPECT_EQ(Parameters(XmlRpcValue()).identifier("grip", "any"), "any");
  expectRefused([] { Parameters(one("grip", XmlRpcValue(40.0))).identifier("grip", "any"); },
                {"~grip", "string or an integer", "type=\"str\""});
}

TEST(Parameters, NumbersAreAListOrOneString) {
  XmlRpcValue list;
  list[0] = 1;
  list[1] = 2.5;
  Parameters as_list(one("start", list)), as_text(one("start", XmlRpcValue("1 2.5"))), none{XmlRpcValue()};
  const std::vector<double> expected = {1, 2.5};
  EXPECT_EQ(as_list.numbers("start", {0, 0}, 0, 9), expected);
  EXPECT_EQ(as_text.numbers("start", {0, 0}, 0, 9), expected);
  EXPECT_EQ(none.numbers("start", expected, 0, 9), expected);
  for (const char* text : {"1", "1 2 3", "1 x", "1 10", "1 nan", ""}) {
    Parameters bad(one("start", XmlRpcValue(text)));
    expectRefused([&] { bad.numbers("start", {0, 0}, 0, 9); }, {"~start", "2 numbers", "0..9"});
  }
  Parameters number(one("start", XmlRpcValue(1)));
  expectRefused([&] { number.numbers("start", {0, 0}, 0, 9); }, {"~start", "2 numbers"});
}

TEST(Parameters, WrongTypeIsRefusedWithTheKey) {
  expectRefused([] { Parameters(one("rate_hz", XmlRpcValue("fast"))).number("rate_hz", 30, 1, 100); },
                {"~rate_hz", "1..100"});
  expectRefused([] { Parameters(one("scene", XmlRpcValue(3))).text("scene", "heart"); }, {"~scene", "string"});
  expectRefused([] { Parameters(one("loop", XmlRpcValue(1))).flag("loop", false); }, {"~loop", "true or false"});
  expectRefused([] { Parameters(one("overrides", XmlRpcValue(1.5))).texts("overrides"); }, {"~overrides", "list"});
}

TEST(Parameters, NumberOutOfRangeOrNotANumberIsRefused) {
  expectRefused([] { Parameters(one("rate_hz", XmlRpcValue(101))).number("rate_hz", 30, 1, 100); }, {"~rate_hz"});
  expectRefused([] { Parameters(one("rate_hz", XmlRpcValue(std::nan("")))).number("rate_hz", 30, 1, 100); },
                {"~rate_hz"});
}

TEST(Parameters, UnknownOneIsRefusedWithTheKnownOnes) {
  Parameters parameters(one("sceen", XmlRpcValue("heart")));
  parameters.text("scene", "heart");
  expectRefused([&] { parameters.refuseOthers(); }, {"~sceen", "~scene"});
}

TEST(Parameters, OverridesComeAsAListOrAsOneString) {
  XmlRpcValue list;
  list[0] = "a=1";
  list[1] = "b=2";
  const std::vector<std::string> both = {"a=1", "b=2"};
  EXPECT_EQ(Parameters(one("overrides", list)).texts("overrides"), both);
  EXPECT_EQ(Parameters(one("overrides", XmlRpcValue("a=1;;b=2; "))).texts("overrides"), both);
}

class SimulatorOptionsTest : public ::testing::Test {
 protected:
  SimulatorOptionsTest() : folder_(std::filesystem::temp_directory_path() / "viscera_options_test") {
    std::filesystem::create_directories(folder_ / "config/scenes");
    std::ofstream(folder_ / "config/scenes/block.yaml") << "bodies: [{source: box, spacing_m: 0.01}]\n";
    std::ofstream(folder_ / "it's a mesh.obj") << "v 0 0 0\n";
  }
  ~SimulatorOptionsTest() override {
    bindFilesTo({}, "");
    std::filesystem::remove_all(folder_);
  }

  SimulatorOptions read(const XmlRpcValue& values) {
    Parameters parameters(values);
    return simulatorOptions(parameters, folder_.string());
  }
  std::filesystem::path folder_;
};

TEST_F(SimulatorOptionsTest, SceneIsANameOrAPath) {
  EXPECT_EQ(read(one("scene", XmlRpcValue("block"))).scene.bodies.at(0).source, TissueSource::kBox);
  const std::string path = (folder_ / "config/scenes/block.yaml").string();
  EXPECT_EQ(read(one("scene", XmlRpcValue(path))).scene.bodies.at(0).source, TissueSource::kBox);
}

TEST_F(SimulatorOptionsTest, MissingSceneIsRefusedWithTheNamesThereAre) {
  expectRefused([&] { read(one("scene", XmlRpcValue("liver"))); }, {"~scene", "liver", "block"});
}

TEST_F(SimulatorOptionsTest, MeshTakesThePlaceOfTheFirstBody) {
  XmlRpcValue values = one("scene", XmlRpcValue("block"));
  const std::string mesh = (folder_ / "it's a mesh.obj").string();
  values["mesh"] = mesh;
  values["mesh_unit_m"] = 0.001;
  const BodyConfig body = read(values).scene.bodies.at(0);
  EXPECT_EQ(body.source, TissueSource::kMesh);
  EXPECT_EQ(body.mesh_file, mesh);
  EXPECT_EQ(body.unit_scale_m, 0.001);
}

TEST_F(SimulatorOptionsTest, MissingMeshIsRefused) {
  XmlRpcValue values = one("scene", XmlRpcValue("block"));
  values["mesh"] = "nowhere.obj";
  expectRefused([&] { read(values); }, {"~mesh", "nowhere.obj"});
}

TEST_F(SimulatorOptionsTest, FilesOutsideOfTheSceneFoldersAreRefusedThereOrNot) {
  std::filesystem::create_directories(folder_ / "data");
  std::ofstream(folder_ / "secret.yaml") << "s3cret: 1\n";
  std::ofstream(folder_ / "data/own.yaml") << "bodies: [{source: box, spacing_m: 0.01}]\n";
  std::filesystem::create_symlink(folder_ / "secret.yaml", folder_ / "data/link.yaml");
  XmlRpcValue values = one("scene_folders", XmlRpcValue((folder_ / "data").string()));
  const auto reading = [&](const std::string& key, const std::string& path) {
    XmlRpcValue all = values;
    all[key] = path;
    if (key != "scene") all["scene"] = "block";
    return [this, all] { read(all); };
  };
  EXPECT_NO_THROW(reading("scene", (folder_ / "data/own.yaml").string())());
  EXPECT_NO_THROW(reading("scene", "block")()) << "the package's own";
  for (const char* name : {"secret.yaml", "absent.yaml", "data/link.yaml", "data/../secret.yaml"}) {
    const std::string path = (folder_ / name).string();
    expectRefused(reading("scene", path), {"~scene_folders", path});
  }
  for (const char* name : {"it's a mesh.obj", "absent.obj"}) {
    const std::string path = (folder_ / name).string();
    expectRefused(reading("mesh", path), {"~scene_folders", path});
  }
  for (const char* folder : {"data", "/nowhere/at/all"}) {
    values["scene_folders"] = folder;
    expectRefused(reading("scene", "block"), {"~scene_folders", folder, "absolute"});
  }
  EXPECT_NO_THROW(read(one("scene", XmlRpcValue((folder_ / "data/own.yaml").string())))) << "any file again";
}

TEST_F(SimulatorOptionsTest, OverridesReachTheScene) {
  XmlRpcValue values = one("scene", XmlRpcValue("block"));
  values["overrides"] = "bodies[0].spacing_m=0.02;solver.tick_hz=50";
  const Scene scene = read(values).scene;
  EXPECT_EQ(scene.bodies.at(0).spacing_m, 0.02);
  EXPECT_EQ(scene.solver.tick_hz, 50);
}

TEST_F(SimulatorOptionsTest, OverrideOfAnUnknownKeyIsRefused) {
  XmlRpcValue values = one("scene", XmlRpcValue("block"));
  values["overrides"] = "bodies[0].spacing_mm=2";
  expectRefused([&] { read(values); }, {"spacing_mm"});
}

/// A scene of `left` and `right`, and one of `left` and `third` with higher limits.
class LaunchLimitsTest : public SimulatorOptionsTest {
 protected:
  LaunchLimitsTest() {
    const std::string block = "bodies: [{source: box, spacing_m: 0.01}]\nstyluses:\n";
    std::ofstream(folder_ / "config/scenes/first.yaml")
        << block + "  - {name: left, max_force_n: 4}\n  - {name: right}\n";
    std::ofstream(folder_ / "config/scenes/second.yaml")
        << block + "  - {name: left, max_force_n: 8}\n  - {name: third, max_torque_nm: 0.3}\n";
    std::filesystem::create_directories(folder_ / "config/devices");
    std::ofstream(folder_ / "config/devices/crtk.yaml")
        << "pose: {type: pose_stamped, topic: poses}\nforce: {type: wrench_stamped, topic: forces, max_force_n: 6}\n";
  }
  SimulatorOptions launch(const std::string& overrides) {
    XmlRpcValue values = one("scene", XmlRpcValue("first"));
    values["overrides"] = overrides;
    return read(values);
  }
  /// Loads a scene like load_scene.
  std::vector<StylusConfig> load(SimulatorOptions options, const Overrides& overrides = {}) {
    options.take({"second", {}, overrides, ""}, folder_.string());
    notes_ = options.limit_notes;
    return options.scene.styluses;
  }
  std::vector<std::string> notes_;  ///< notes of load()
};

TEST_F(LaunchLimitsTest, AreBoundsOfEveryLaterSceneAndOverride) {
  const SimulatorOptions first = launch("styluses[0].max_force_n=1;styluses[1].max_force_rate_n_per_s=50");
  EXPECT_EQ(first.scene.styluses.at(0).max_force_n, 1);
  EXPECT_TRUE(first.limit_notes.empty());
  EXPECT_EQ(load(first).at(0).max_force_n, 1);
  ASSERT_EQ(notes_.size(), 3U);
  EXPECT_EQ(notes_[0], "stylus left: max_force_n is 1, as set by the ~overrides of the launch file, not 8");
  const std::vector<StylusConfig> later = load(first, {"styluses[0].max_force_n=10"});
  EXPECT_EQ(later.at(0).max_force_n, 1);
  EXPECT_EQ(later.at(0).max_force_rate_n_per_s, 100) << "of the other stylus alone";
  EXPECT_EQ(load(first, {"styluses[0].max_force_n=0.5"}).at(0).max_force_n, 0.5) << "less may be asked for";
}

TEST_F(LaunchLimitsTest, HoldForStylusesOfOtherNames) {
  const SimulatorOptions first = launch("styluses[0].max_force_n=2;styluses[1].max_force_n=1");
  const std::vector<StylusConfig> later = load(first);
  EXPECT_EQ(later.at(0).max_force_n, 2);
  EXPECT_EQ(later.at(1).max_force_n, 1);
  EXPECT_EQ(later.at(1).max_torque_nm, 0.3) << "no override sets it";
}

TEST_F(LaunchLimitsTest, OfWholeStylusesAreThoseTheyName) {
  const SimulatorOptions one_stylus = launch("styluses[0]={name: left, max_force_n: 1, grasper: {max_force_n: 3}}");
  EXPECT_EQ(load(one_stylus).at(0).max_force_n, 1);
  const SimulatorOptions all = launch("styluses=[{name: left, max_torque_nm: 0.1}]");
  EXPECT_EQ(load(all).at(0).max_torque_nm, 0.1);
  EXPECT_EQ(load(all).at(0).max_force_n, 6) << "that of the device";
}

TEST_F(LaunchLimitsTest, OfASceneFileAreOfThatSceneAlone) {
  const SimulatorOptions first = launch("");
  EXPECT_EQ(first.scene.styluses.at(0).max_force_n, 4);
  EXPECT_EQ(load(first).at(0).max_force_n, 6) << "that of the device";
  EXPECT_TRUE(notes_.empty());
}

TEST_F(SimulatorOptionsTest, AnchoredStrokesAreBroughtToTheSkinOfTheScene) {
  std::ofstream(folder_ / "anchored.yaml") << "strokes:\n"
                                              "  - stylus: hand\n"
                                              "    anchor: {from_m: [0, -0.3, 0], towards_m: [0, 0, 0]}\n"
                                              "    keys: [{t_s: 0, position_m: [0, 0, 0.01]}]\n";
  XmlRpcValue values = one("strokes", XmlRpcValue((folder_ / "anchored.yaml").string()));
  Parameters without(values);
  expectRefused([&] { replayOptions(without, folder_.string()); }, {"~scene"});

  values["scene"] = "block";  // a box of 0.05 m about the origin: its surface is at y = -0.025 m
  Parameters with(values);
  const ReplayOptions options = replayOptions(with, folder_.string());
  EXPECT_FALSE(options.strokes.anchored());
  EXPECT_NEAR(options.strokes.strokes.at(0).keys.at(0).pose.position_m.y(), -0.035, kCell_m);
  EXPECT_EQ(options.frame, "tissue");
}

TEST(ReplayOptions, StrokesMustBeNamed) {
  Parameters parameters{XmlRpcValue()};
  expectRefused([&] { replayOptions(parameters, "/nowhere"); }, {"~strokes"});
}

}  // namespace
}  // namespace viscera::nodes
