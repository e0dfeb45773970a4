// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Errors and notes name the place of a mistake, a likely correction, and settings without effect.
#include <gtest/gtest.h>

#include <filesystem>

#include "cli/small_scene.h"
#include "support/temporary_folder.h"

namespace viscera {
namespace {

using namespace test;

class Messages : public ::testing::Test {
 protected:
  /// Returns the one line with which the command gives up.
  static std::string lineOf(const std::vector<std::string>& arguments) {
    const Ending ending = viscera(arguments);
    EXPECT_NE(ending.status, 0);
    const std::vector<std::string> lines = complaints(ending);
    return lines.size() == 1 ? lines[0] : "not one line: " + ending.err;
  }
  std::string lineOfScene(const std::string& yaml) const {
    return lineOf({"run", folder_.write("bad.yaml", yaml), "--no-view", "--seconds", "0.01"});
  }
  static void expectSays(const std::string& line, const std::string& text) {
    EXPECT_NE(line.find(text), std::string::npos) << line;
  }
  /// Returns the output of a run before its JSON. @param more  further options of the block scene
  std::string notesOf(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = {"run", scene_, "--no-view", "--seconds", "0.01"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Ending ending = viscera(arguments);
    EXPECT_EQ(ending.status, 0) << ending.err;
    return ending.out;
  }

  TemporaryFolder folder_;
  const std::string scene_ = folder_.write("scene.yaml", kBlockScene);
};

TEST_F(Messages, CheckSaysHowManyCellsTheWallsOfASceneHave) {
  const Ending heart = viscera({"check", "heart", "--set", "bodies[0].spacing_m=0.006"});
  EXPECT_EQ(heart.status, 0) << heart.err;
  expectSays(heart.out, "spacing 6 mm");
  expectSays(heart.out, "walls: thinnest ");
  expectSays(heart.out, " % (an open bowl) too stiff in bending, at most ");
  expectSays(heart.out, "; at spacing_m 0.00");
  const Ending rows =
      viscera({"check", "heart", "--set", "bodies[0].spacing_m=0.008", "--set", "bodies[0].material.walls=rows"});
  EXPECT_EQ(rows.status, 0) << rows.err;
  expectSays(rows.out, "material.walls: rows: used in ");
  expectSays(rows.out, " % (an open bowl) too stiff in bending; at spacing_m 0.00");
  const Ending block = viscera({"check", scene_});
  EXPECT_EQ(block.status, 0) << block.err;
  expectSays(block.out, "walls: thinnest ");
  expectSays(lineOf({"check", "--set", "bodies[0].spacing_m=0.006"}), "--set requires scene");
  expectSays(lineOf({"check", "nosuch"}), "'nosuch' is neither a file nor the name of a shipped scene");
}

TEST_F(Messages, CallTabsAndWrongIndentsSo) {
  const std::string tab = "indented by a tab; YAML accepts only spaces";
  expectSays(lineOfScene("name: a\nbodies:\n\t- name: b\n"), "bad.yaml:3: the line is " + tab);
  expectSays(lineOfScene("name: a\nbodies:\n  - name: b\n\t  source: box\n"), "bad.yaml:4: the line is " + tab);
  expectSays(lineOfScene("name: a\nbodies:\n  - name: b\n   source: box\n"),
             "bad.yaml:4: wrong indentation: the line is indented by 3, keys above by 0, 4");
  expectSays(lineOfScene("name: a\nbodies:\n  - name: b\n    source: box\n  spacing_m: 1\n"),
             "bad.yaml:5: wrong indentation: the line is indented by 2, keys above by 0, 4");
  expectSays(lineOfScene("name: a\nsolver:\n  tick_hz: 100\n    max_substeps: 4\n"),
             "bad.yaml:4: wrong indentation: the line is indented by 4, keys above by 0, 2");
  expectSays(lineOfScene("bodies:\n   - name: a\n  - name: b\n"),
             "bad.yaml:3: wrong indentation: the line is indented by 2, items above by 3");
  const std::string other = lineOfScene("name: a: b\n");
  expectSays(other, "bad.yaml:1: ");
  EXPECT_EQ(other.find("indent"), std::string::npos) << other;
}

TEST_F(Messages, NameWhatIsNearestFirst) {
  expectSays(lineOf({"rnu", "heart"}), "nearest to 'rnu' are run, ");
  expectSays(lineOf({"run", "heart", "--sceonds", "1"}), "nearest to '--sceonds' are --seconds, ");
  expectSays(lineOf({"run", "heart", "--out", "out", "--export", "surface"}),
             "--export: surface not in {lattice,network,skin,sutures}");
  expectSays(lineOf({"run", "heard"}), "shipped: heart, ");
  expectSays(lineOf({"task", "cut_a_disk"}), "is neither a file nor the name of a shipped task; shipped: ");
  const std::string key = lineOf({"run", scene_, "--set", "solver.max_substep=3"});
  expectSays(key, "unknown key 'solver.max_substep'; accepted here: max_substeps, ");
  expectSays(lineOf({"run", scene_, "--set", "solver.backend=gqu"}), "must be one of gpu, ");
}

TEST_F(Messages, RefuseOptionsThatWriteNothing) {
  const std::string out = folder_.file("out");
  const auto run = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"run", scene_, "--out", out, "--no-view", "--seconds", "0.1"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return lineOf(arguments);
  };
  expectSays(run({"--export", "sutures"}), "--export sutures: the scene has no sutures");
  expectSays(run({"--export", "network"}), "--export network: no body has structure explicit");
  expectSays(run({"--export", "skin", "--every", "2"}), "--every 2 s is longer than the run, 0.1 s");
  expectSays(run({"--depth"}), "--depth: needs pictures; remove --no-view");
  expectSays(run({"--labels"}), "--labels: needs pictures");
  EXPECT_FALSE(std::filesystem::exists(out)) << "nothing is made before the run is refused";
}

TEST_F(Messages, SayFileAndLineOfPartsRegionsAndMeshes) {
  const std::string body =
      "bodies:\n  - name: a\n    source: box\n    box_size_m: [0.04, 0.04, 0.04]\n    spacing_m: 0.01\n";
  expectSays(lineOfScene(body + "    fixed:\n      - {shape: part, part: bix}\n"),
             "bad.yaml:7: bodies[0].fixed[0]: no part 'bix'");
  expectSays(lineOfScene(body + "    fixed:\n      - {shape: sphere, center_m: [1, 0, 0], radius_m: 0.01}\n"),
             "bad.yaml:7: bodies[0].fixed[0] matches no node");
  expectSays(lineOfScene(body + "    parts:\n      - {part: bix}\n"), "bad.yaml:7: bodies[0].parts[0] names 'bix'");
  expectSays(lineOfScene("name: a\nbodies:\n  - name: a\n    source: mesh\n    mesh_file: none.obj\n"),
             "bad.yaml:3: bodies[0]: mesh file '");
}

TEST_F(Messages, NoteWhatHasNoEffectOrIsStrange) {
  const std::string soft = "is softer than any organ; was it given in kPa?";
  EXPECT_NE(notesOf({"--set", "bodies[0].material.young_modulus_pa=20"}).find(soft), std::string::npos);
  EXPECT_EQ(notesOf({}).find(soft), std::string::npos);
  EXPECT_NE(notesOf({"--set", "bodies[0].target_nodes=200"}).find("spacing_m 0.01 is ignored: target_nodes 200"),
            std::string::npos);
  const std::string far = folder_.write("far.yaml",
                                        "strokes:\n  - stylus: left\n    keys:\n"
                                        "      - {t_s: 0, position_m: [0, 0, 50], rotation_deg: [0, 0, 0]}\n");
  EXPECT_NE(notesOf({"--strokes", far}).find("stylus 'left' goes 50 m from the tissue frame, beyond its workspace_m"),
            std::string::npos);
}

}  // namespace
}  // namespace viscera
