// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Sessions that the command records and replays.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "cli/small_scene.h"
#include "support/source_folder.h"
#include "support/temporary_folder.h"

namespace viscera {
namespace {

using namespace test;

constexpr const char* kStrokes =
    "strokes:\n"
    "  - stylus: left\n"
    "    keys:\n"
    "      - {t_s: 0, position_m: [0, 0, 0.05], rotation_deg: [0, 0, 0]}\n"
    "      - {t_s: 0.5, position_m: [0, 0, -0.035], rotation_deg: [0, 0, 0]}\n";

class ReplayCommand : public ::testing::Test {
 protected:
  Ending record(const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"run", scene_, "--strokes", strokes_, "--no-view", "--record", file_};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return viscera(arguments);
  }
  static nlohmann::json resultOf(const Ending& ending) {
    const std::vector<std::string> lines = linesOf(ending.out);
    return lines.empty() ? nlohmann::json() : nlohmann::json::parse(lines.back(), nullptr, false);
  }
  TemporaryFolder folder_;
  const std::string scene_ = folder_.write("scene.yaml", kBlockScene);
  const std::string strokes_ = folder_.write("strokes.yaml", kStrokes);
  const std::string file_ = folder_.file("session.viscera");
};

TEST_F(ReplayCommand, EndsInTheRecordedHashThreeTimes) {
  const nlohmann::json live = resultOf(record({"--seconds", "1"}));
  ASSERT_TRUE(live.contains("state_hash"));
  for (int time = 0; time < 3; ++time) {
    const Ending ending = viscera({"replay", file_, "--no-view"});
    ASSERT_EQ(ending.status, 0) << ending.err;
    const nlohmann::json replayed = resultOf(ending);
    EXPECT_EQ(replayed["state_hash"], live["state_hash"]);
    EXPECT_EQ(replayed["recorded_hash_met"], true);
    EXPECT_EQ(replayed["to_recorded_end"], true);
    EXPECT_EQ(replayed["pieces"][0], live["tools"]) << "measures are those of the session";
  }
  EXPECT_NEAR(live["tools"][0]["path_m"], 0.085 * 29 / 30, 1e-9) << "from the first tick to the end of the stroke";
  EXPECT_LT(live["tools"][0]["sparc"], -1);
}

TEST_F(ReplayCommand, WhatWasRecordedBeforeAKillReplays) {
  Ending ending;
  for (const char* seconds : {"2", "10", "40"}) {  // a busy machine has hardly begun after the first
    std::filesystem::remove(file_);
    runProgram("timeout",
               {"-s", "KILL", seconds, kCommand, "run", scene_, "--no-view", "--seconds", "80000", "--record", file_});
    ending = viscera({"replay", file_, "--no-view", "--until", "5"});
    if (ending.status == 0 && resultOf(ending)["recorded_s"] > 1) break;
  }
  ASSERT_EQ(ending.status, 0) << ending.err;
  EXPECT_NE(ending.err.find("replayed up to that point"), std::string::npos) << ending.err;
  const nlohmann::json replayed = resultOf(ending);
  EXPECT_GT(replayed["recorded_s"], 1);
  EXPECT_TRUE(replayed.contains("cut"));
  EXPECT_EQ(replayed["recorded_hash_met"], true);
}

TEST_F(ReplayCommand, SavesTheStateOfAnyMoment) {
  ASSERT_EQ(record({"--seconds", "1"}).status, 0);
  const std::string state = folder_.file("state");
  ASSERT_EQ(viscera({"replay", file_, "--no-view", "--until", "0.5", "--save", state}).status, 0);
  const nlohmann::json half =
      resultOf(viscera({"run", scene_, "--strokes", strokes_, "--no-view", "--seconds", "0.5"}));
  const nlohmann::json resumed = resultOf(viscera({"run", scene_, "--no-view", "--seconds", "0.5", "--resume", state}));
  EXPECT_EQ(resumed["state_hash"], half["state_hash"]);
}

TEST_F(ReplayCommand, WritesPicturesOfOtherCameras) {
  ASSERT_EQ(record({"--seconds", "0.2"}).status, 0);
  const std::string out = folder_.file("out");
  const Ending ending = viscera({"replay", file_, "--out", out, "--depth", "--labels", "--set",
                                 "cameras=[{name: other, position_m: [0, -0.3, 0], width_px: 32, height_px: 32}]",
                                 "--set", "bodies[0].color=[0, 0, 1]", "--set", "solver.backend=cpu"});
  // solver.backend must not be changed
  EXPECT_NE(ending.status, 0);
  EXPECT_NE(ending.err.find("solver.backend"), std::string::npos) << ending.err;
  const Ending taken = viscera({"replay", file_, "--out", out, "--depth", "--labels", "--set",
                                "cameras=[{name: other, position_m: [0, -0.3, 0], width_px: 32, height_px: 32}]",
                                "--set", "bodies[0].color=[0, 0, 1]"});
  ASSERT_EQ(taken.status, 0) << taken.err;
  for (const char* file : {"frames/other_000012.png", "frames/other_depth_000012.npy", "frames/other_labels_000012.png",
                           "tools.csv", "metrics.json", "surface.ply"})
    EXPECT_TRUE(std::filesystem::exists(out + "/" + file)) << file;
  EXPECT_EQ(linesOf(readFile(out + "/tools.csv")).size(), 13U);
}

TEST_F(ReplayCommand, SaysWhatIsWrong) {
  const std::vector<std::pair<std::vector<std::string>, std::string>> cases = {
      {{"replay", scene_}, "scene.yaml: is not a recorded session"},
      {{"replay", folder_.file("none")}, "none: cannot be read"},
      {{"replay", folder_.path()}, "is not a recorded session"},
      {{"run", scene_, "--no-view", "--record", scene_}, "scene.yaml: cannot be written: this command reads it"},
      {{"run", scene_, "--no-view", "--record", folder_.file("a/b")}, "a/b: cannot be created for a recording"},
  };
  for (const auto& [arguments, text] : cases) {
    const Ending ending = viscera(arguments);
    EXPECT_EQ(ending.status, 1);
    EXPECT_NE(ending.err.find(text), std::string::npos) << ending.err;
    EXPECT_EQ(complaints(ending).size(), 1U) << ending.err;
  }
  ASSERT_EQ(record({"--seconds", "0.1"}).status, 0);
  const Ending order = viscera({"replay", file_, "--from", "2", "--until", "1"});
  EXPECT_NE(order.err.find("--until must not be before --from"), std::string::npos) << order.err;
}

}  // namespace
}  // namespace viscera
