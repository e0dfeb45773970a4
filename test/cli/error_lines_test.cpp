// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>

#include "cli/small_scene.h"
#include "math/one_line.h"
#include "support/source_folder.h"
#include "support/text.h"

namespace viscera {
namespace {

using namespace test;

/// Errors are reported in one line that is safe to print, for any input.
class ErrorLines : public ::testing::Test {
 protected:
  static std::string lineOf(const Ending& ending, bool is_understood = true) {
    EXPECT_TRUE(is_understood ? ending.status == 1 : ending.status > 100) << ending.status << ": " << ending.err;
    const std::vector<std::string> errors = complaints(ending);
    EXPECT_EQ(errors.size(), 1u) << ending.err;
    if (errors.empty()) return "";
    EXPECT_LE(errors[0].size(), kLongestLine + std::string("viscera: error: ").size());
    EXPECT_TRUE(std::none_of(errors[0].begin(), errors[0].end(), [](unsigned char c) { return c < ' ' || c == 0x7f; }))
        << errors[0];
    return errors[0];
  }
  std::string lineOfRun(std::vector<std::string> options, bool is_understood = true) {
    options.insert(options.begin(), {"run", scene_, "--no-view", "--seconds", "0.05"});
    return lineOf(viscera(options), is_understood);
  }

  TemporaryFolder folder_;
  std::string scene_ = folder_.write("block.yaml", kBlockScene);
};

TEST_F(ErrorLines, ControlCharactersOfTheInputAreEscaped) {
  EXPECT_TRUE(says(lineOfRun({"--set", "bodies[0].spa\ncing_m=1"}), {"override", "spa\\ncing_m"}));
  EXPECT_TRUE(says(lineOfRun({"--strokes", "no\x1b[31mne.yaml"}), {"no\\x1b[31mne.yaml"}));
  const std::string spoilt = folder_.write("spoilt.yaml", std::string(kBlockScene) + "\"a\\ab\": 1\n");
  EXPECT_TRUE(says(lineOf(viscera({"run", spoilt, "--no-view"})), {"spoilt.yaml:10: ", "a\\x07b"}));
  const std::string msh = folder_.write("mesh.msh", "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n\x10\x1b[2J\n");
  const std::string scene = folder_.write("msh.yaml", "bodies: [{name: a, source: mesh, mesh_file: mesh.msh}]\n");
  EXPECT_TRUE(says(lineOf(viscera({"run", scene, "--no-view"})), {"mesh.msh': line 5: '\\x10\\x1b[2J'"}));
}

TEST_F(ErrorLines, LongInputIsCutInTheMiddle) {
  const std::string line = lineOfRun({"--set", "bodies[0].spacing_m=" + std::string(50000, 'x')});
  EXPECT_TRUE(says(line, {"override: 'bodies[0].spacing_m' must be a number", " ... "}));
  EXPECT_TRUE(says(lineOfRun({"--strokes", std::string(3000, 'n') + ".yaml"}), {"nnn ... nnn", "cannot be read"}));
}

TEST_F(ErrorLines, CommandLineIsRefusedInOneLineToo) {
  EXPECT_TRUE(says(lineOf(viscera({}), false), {"command line", "`viscera --help`"}));
  EXPECT_TRUE(says(lineOf(viscera({"fly"}), false), {"command line", "`viscera --help`"}));
  EXPECT_TRUE(says(lineOf(viscera({"run"}), false), {"command line", "scene", "`viscera run --help`"}));
  EXPECT_TRUE(says(lineOfRun({"--fl\ny"}, false), {"command line", "--fl\\ny", "`viscera run --help`"}));
  EXPECT_TRUE(says(lineOfRun({"--seconds", "soon"}, false), {"--seconds", "soon"}));
  EXPECT_TRUE(
      says(lineOf(viscera({"bench", "speed", "--nodes", "0"}), false), {"--nodes", "viscera bench speed --help`"}));
}

TEST_F(ErrorLines, VersionIsNoError) {
  const auto result = viscera({"--version"});
  EXPECT_EQ(result.status, 0);
  EXPECT_TRUE(says(result.out, {"viscera 1."}));
}

TEST_F(ErrorLines, MemoryThatDoesNotSufficeSaysWhatFor) {
  // A million cells need about 100 MB more than a program that has loaded its libraries.
  const std::string command = "ulimit -v 600000; exec " + shellQuoted(kCommand) + " run " + shellQuoted(scene_) +
                              " --no-view --set bodies[0].spacing_m=0.0001";
  const std::string line = lineOf(runProgram("bash", {"-c", command}));
  EXPECT_TRUE(says(line, {scene_, "body 'block'", "spacing_m 0.0001", "memory"}));
}

TEST_F(ErrorLines, WhatIsWrongWithABodyNamesTheScene) {
  EXPECT_TRUE(says(lineOfRun({"--set", "bodies[0].fixed=[{shape: sphere, center_m: [1, 1, 1]}]"}),
                   {scene_ + ":7: bodies[0].fixed[0]", "no node"}));
  EXPECT_TRUE(says(lineOfRun({"--set", "bodies[0].spacing_m=5"}), {scene_ + ": body 'block'", "spacing_m 5"}));
}

TEST_F(ErrorLines, SceneWithoutEndIsNotReadToIt) {
  EXPECT_TRUE(says(lineOf(viscera({"run", "/dev/zero", "--no-view"})), {"/dev/zero", "100 MB"}));
  EXPECT_TRUE(says(lineOfRun({"--strokes", "/dev/zero"}), {"/dev/zero", "100 MB"}));
}

TEST_F(ErrorLines, NestingIsNamedAsSuch) {
  const std::string deep = folder_.write("deep.yaml", "bodies: " + std::string(100000, '['));
  EXPECT_TRUE(says(lineOf(viscera({"run", deep, "--no-view"})), {"deep.yaml:1: ", "nested too deep"}));
}

}  // namespace
}  // namespace viscera
