// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Keys that had another name before 1.0: `viscera upgrade` renames them, and every other command names the new one.
#include <gtest/gtest.h>

#include "cli/small_scene.h"
#include "support/temporary_folder.h"

namespace viscera {
namespace {

using namespace test;

constexpr const char* kOld =
    "# governor: a comment stays as it is\n"
    "bodies:\n"
    "  - name: drag_per_s  # a value, not a key\n"
    "    source: box\n"
    "    wetness: 0.5\n"
    "    material: {dashpot_ratio: 0.1, \"drag_per_s\": 3}\n"
    "solver: {governor: false, threads: 1}\n"
    "threads:\n"
    "  - {name: suture, usp: 4-0, path: [{position_m: [0.03, 0, 0]}], start: fixed, drag_per_s: 2}\n";
constexpr const char* kNew =
    "# governor: a comment stays as it is\n"
    "bodies:\n"
    "  - name: drag_per_s  # a value, not a key\n"
    "    source: box\n"
    "    specular_wetness: 0.5\n"
    "    material: {stiffness_damping_ratio: 0.1, \"mass_damping_per_s\": 3}\n"
    "solver: {stability_monitor: false, threads: 1}\n"
    "sutures:\n"
    "  - {name: suture, usp: 4-0, path: [{position_m: [0.03, 0, 0]}], start: fixed, mass_damping_per_s: 2}\n";

TEST(Upgrade, RenamesKeysAndLeavesTheRestOfAFile) {
  TemporaryFolder folder;
  const std::string scene = folder.write("scene.yaml", kOld);
  const std::string strokes = folder.write("strokes.yaml", "hands_anew: [1, 3]\nstrokes: []\n");
  const std::string plan = folder.write("plan.yaml", "grid:\n  bodies[0].material.drag_per_s: [1, 2]\n");
  const Ending ending = viscera({"upgrade", scene, strokes, plan});
  ASSERT_EQ(ending.status, 0) << ending.err;
  EXPECT_EQ(readFile(scene), kNew);
  EXPECT_EQ(readFile(strokes), "input_reset: [1, 3]\nstrokes: []\n");
  EXPECT_EQ(readFile(plan), "grid:\n  bodies[0].material.mass_damping_per_s: [1, 2]\n");
  EXPECT_NE(ending.out.find("solver.governor -> solver.stability_monitor"), std::string::npos) << ending.out;
  EXPECT_NE(ending.out.find("threads[0].drag_per_s -> sutures[0].mass_damping_per_s"), std::string::npos) << ending.out;

  const Ending again = viscera({"upgrade", scene});
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_NE(again.out.find("scene.yaml: nothing to rename"), std::string::npos) << again.out;
  EXPECT_EQ(readFile(scene), kNew);
  EXPECT_EQ(viscera({"run", scene, "--no-view", "--seconds", "0.05"}).status, 0);
}

TEST(Upgrade, RenamesWhatAnAliasRepeatsOnce) {
  TemporaryFolder folder;
  const std::string scene = folder.write(
      "scene.yaml",
      "bodies:\n  - {name: \xc3\xa4, material: &soft {drag_per_s: 3}}\n  - {name: b, material: *soft, wetness: 1}\n");
  const Ending ending = viscera({"upgrade", scene});
  ASSERT_EQ(ending.status, 0) << ending.err;
  EXPECT_EQ(readFile(scene),
            "bodies:\n  - {name: \xc3\xa4, material: &soft {mass_damping_per_s: 3}}\n"
            "  - {name: b, material: *soft, specular_wetness: 1}\n");
  EXPECT_EQ(viscera({"upgrade", folder.write("loop.yaml", "a: &a [*a]\n")}).status, 0);
}

TEST(Upgrade, WritesNothingIfAFileIsNoYaml) {
  TemporaryFolder folder;
  const std::string scene = folder.write("scene.yaml", kOld), broken = folder.write("broken.yaml", "a: [1\n");
  const Ending ending = viscera({"upgrade", scene, broken});
  EXPECT_NE(ending.status, 0);
  EXPECT_NE(ending.err.find("broken.yaml"), std::string::npos) << ending.err;
  EXPECT_EQ(readFile(scene), kOld);
}

TEST(Upgrade, IsNamedWhereAnOldKeyIsRead) {
  TemporaryFolder folder;
  const std::string scene = folder.write("scene.yaml", kOld);
  const Ending file = viscera({"run", scene, "--no-view", "--seconds", "0.01"});
  EXPECT_NE(file.err.find(" in this version; `viscera upgrade FILE` renames the keys of a file"), std::string::npos)
      << file.err;
  const std::string small = folder.write("small.yaml", kBlockScene);
  const Ending set = viscera({"run", small, "--no-view", "--seconds", "0.01", "--set", "solver.governor=false"});
  EXPECT_NE(set.err.find("'solver.governor' is named 'solver.stability_monitor' in this version"), std::string::npos)
      << set.err;
}

}  // namespace
}  // namespace viscera
