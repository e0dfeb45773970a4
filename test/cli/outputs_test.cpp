// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// The command's outputs destroy nothing: no input, no file of another kind, and no file if the disk is full.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <set>

#include "cli/small_scene.h"
#include "support/source_folder.h"
#include "support/temporary_folder.h"

namespace viscera {
namespace {

using namespace test;

class Outputs : public ::testing::Test {
 protected:
  std::set<std::string> files(const std::string& folder = "") const {
    std::set<std::string> out;
    const std::string top = folder_.path() + folder;
    for (const auto& file : std::filesystem::recursive_directory_iterator(top))
      if (file.is_regular_file()) out.insert(file.path().lexically_relative(top).string());
    return out;
  }
  /// Expects an error in one line, and unchanged files.
  void expectRefused(const std::vector<std::string>& arguments, const std::string& says) const {
    std::map<std::string, std::string> before;
    for (const std::string& name : files()) before[name] = readFile(folder_.file(name));
    const Ending ending = viscera(arguments);
    EXPECT_NE(ending.status, 0) << says;
    const std::vector<std::string> lines = complaints(ending);
    ASSERT_EQ(lines.size(), 1U) << ending.err;
    EXPECT_NE(lines[0].find(says), std::string::npos) << lines[0];
    EXPECT_EQ(files().size(), before.size());
    for (const auto& [name, bytes] : before) EXPECT_EQ(readFile(folder_.file(name)), bytes) << name;
  }
  /// Runs a command as on a full disk. @param blocks  largest file size, in blocks of 512 bytes
  Ending withFileLimit(int blocks, const std::vector<std::string>& arguments) const {
    std::string command = "trap '' XFSZ; ulimit -f " + std::to_string(blocks) + "; exec " + shellQuoted(kCommand);
    for (const std::string& argument : arguments) command += " " + shellQuoted(argument);
    Ending ending = runProgram("sh", {"-c", command + " 2>&1"});  // because files cannot grow
    ending.err = ending.out;
    return ending;
  }

  TemporaryFolder folder_;
  const std::string scene_ = folder_.write("scene.yaml", kBlockScene);
  const std::string strokes_ = folder_.write("strokes.yaml",
                                             "strokes:\n  - stylus: left\n    keys:\n"
                                             "      - {t_s: 0, position_m: [0, 0, 0.05], rotation_deg: [0, 0, 0]}\n"
                                             "      - {t_s: 0.1, position_m: [0, 0, 0.04], rotation_deg: [0, 0, 0]}\n");
  const std::string mesh_ = folder_.write("mesh.obj",
                                          "v 0 0 0\nv 0.04 0 0\nv 0 0.04 0\nv 0 0 0.04\n"
                                          "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
};

TEST_F(Outputs, NeverReplaceAnInput) {
  const std::string reads = "cannot be written: this command reads it";
  const std::vector<std::string> run = {"run", scene_, "--no-view", "--seconds", "0.1"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), run.begin(), run.end());
    return more;
  };
  expectRefused({"anchor", scene_, "--strokes", strokes_, "--out", scene_}, scene_ + ": cannot be written");
  expectRefused({"anchor", scene_, "--strokes", strokes_, "--out", strokes_}, strokes_ + ": " + reads);
  expectRefused({"fit", scene_, "--mesh", mesh_, "--out", mesh_}, mesh_ + ": " + reads);
  expectRefused({"fit", scene_, "--mesh", mesh_, "--out", scene_}, scene_ + ": " + reads);
  expectRefused(with({"--save", scene_}), scene_ + ": cannot be written");
  expectRefused(with({"--strokes", strokes_, "--save", strokes_}), strokes_ + ": cannot be written");
  const std::string file = folder_.file("recording"), out = folder_.file("out");
  ASSERT_EQ(viscera(with({"--record", file})).status, 0);
  expectRefused({"replay", file, "--no-view", "--save", file}, file + ": cannot be written");
  ASSERT_EQ(viscera(with({"--out", out})).status, 0);
  const std::string skin = out + "/surface.ply";
  ASSERT_TRUE(std::filesystem::exists(skin));
  expectRefused(with({"--mesh", skin, "--out", out}), skin + ": " + reads);
}

TEST_F(Outputs, OfOneRunHaveNamesOfTheirOwn) {
  const std::string file = folder_.file("trial1"), out = folder_.file("out");
  expectRefused({"run", scene_, "--no-view", "--record", file, "--save", folder_.path() + "/./trial1"},
                "--save and --record both write " + file);
  expectRefused({"run", scene_, "--no-view", "--out", out, "--save", out + "/metrics.json"},
                "--out and --save both write");
  ASSERT_EQ(viscera({"run", scene_, "--no-view", "--seconds", "0.1", "--record", file}).status, 0);
  expectRefused({"run", scene_, "--no-view", "--save", file},
                file + ": cannot be written: it already exists as a recording");
}

TEST_F(Outputs, StatesGoOnUnderOneNameAndEndInPartAsTheyLike) {
  const std::string state = folder_.file("x"), part = folder_.file("x.part");
  const auto save = [&](const std::string& file, const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"run", scene_, "--no-view", "--save", file};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return viscera(arguments).status;
  };
  ASSERT_EQ(save(part, {"--seconds", "0.1"}), 0);
  const std::string bytes = readFile(part);
  ASSERT_EQ(save(state, {"--seconds", "0.2"}), 0);
  EXPECT_EQ(readFile(part), bytes);
  EXPECT_EQ(save(state, {"--resume", state, "--seconds", "0.3"}), 0);
  EXPECT_EQ(files(), (std::set<std::string>{"mesh.obj", "scene.yaml", "strokes.yaml", "x", "x.part"}));
}

TEST_F(Outputs, OfAnOlderRunGoCompletely) {
  const std::string out = folder_.file("out");
  const auto run = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"run", scene_, "--out", out};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return viscera(arguments);
  };
  ASSERT_EQ(run({"--no-view", "--strokes", strokes_, "--seconds", "0.5", "--export", "skin", "--save", out + "/state"})
                .status,
            0);
  EXPECT_EQ(files("/out").count("tools.csv"), 1U);
  EXPECT_EQ(files("/out").count("export/skin.pvd"), 1U);
  folder_.write("out/notes.txt", "mine");
  folder_.write("out/export/mine.vtp", "mine");
  const Ending second = run({"--no-view", "--seconds", "0.1"});
  ASSERT_EQ(second.status, 0) << second.err;
  EXPECT_NE(second.out.find(out + ": replaces an older run"), std::string::npos) << second.out;
  EXPECT_EQ(files("/out"), (std::set<std::string>{".viscera_run", "export/mine.vtp", "metrics.json", "notes.txt",
                                                  "state", "surface.ply"}));
}

TEST_F(Outputs, OneUsdFileHasEveryMomentOfARun) {
  const std::string out = folder_.file("out");
  const Ending ending = viscera({"run", scene_, "--no-view", "--strokes", strokes_, "--seconds", "0.2", "--out", out,
                                 "--export", "skin", "--every", "0.05", "--format", "usda"});
  ASSERT_EQ(ending.status, 0) << ending.err;
  const std::string usd = readFile(out + "/export/skin.usda");
  EXPECT_EQ(usd.rfind("#usda 1.0\n", 0), 0U);
  for (const char* const part : {"timeCodesPerSecond = 20\n", "endTimeCode = 4 ", "            1: [(",
                                 "            4: [(", "def Xform \"tool_left\"", "\"inherited\""})
    EXPECT_NE(usd.find(part), std::string::npos) << part;
  EXPECT_EQ(usd.find("            5: "), std::string::npos);
}

TEST_F(Outputs, AFullDiskLeavesNothingBehind) {
  const std::set<std::string> before = files();
  const std::string file = folder_.file("x");
  const std::vector<std::vector<std::string>> all = {
      {"run", scene_, "--no-view", "--seconds", "0.1", "--save", file},
      {"run", scene_, "--no-view", "--seconds", "0.1", "--record", file},
      {"fit", scene_, "--mesh", mesh_, "--out", file},
      {"anchor", scene_, "--strokes", strokes_, "--out", file},
  };
  for (const std::vector<std::string>& arguments : all) {
    const Ending ending = withFileLimit(0, arguments);
    EXPECT_EQ(ending.status, 1) << arguments[0];
    const std::vector<std::string> lines = complaints(ending);
    ASSERT_EQ(lines.size(), 1U) << ending.err;
    EXPECT_NE(lines[0].find(file + ": "), std::string::npos) << lines[0];
    EXPECT_NE(lines[0].find("File too large"), std::string::npos) << lines[0];
    EXPECT_EQ(files(), before) << arguments[0];
  }
  EXPECT_EQ(withFileLimit(1, {"run", scene_, "--no-view", "--seconds", "0.1", "--record", file}).status, 1);
  EXPECT_EQ(files(), before) << "the first chunk did not fit, the head did";
}

}  // namespace
}  // namespace viscera
