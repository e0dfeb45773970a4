// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <filesystem>

#include "support/source_folder.h"
#include "tasks/task_kinds.h"
#include "tasks/task_report.h"

namespace viscera {
namespace {

constexpr const char* kTask =
    "scene: gauze\n"
    "kind: cut_disc\n"
    "cut_disc: {radius_m: 0.02}\n"
    "measures: [{measure: off_path_mm, cost_s: 2}]\n";

std::string errorOf(const std::string& yaml) {
  try {
    parseTask(yaml, "task.yaml");
  } catch (const TaskError& error) {
    return error.what();
  }
  return "";
}

bool names(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& word : words)
    if (text.find(word) == std::string::npos) return false;
  return true;
}

TEST(TaskFile, ErrorsNameFileLineKeyAndWhatIsAccepted) {
  EXPECT_EQ(errorOf(kTask), "");
  const std::string task = kTask;
  EXPECT_TRUE(names(errorOf(task + "time_limit_s: 0\n"), {"task.yaml:5: ", "'time_limit_s'", "0.1 .. 86400"}));
  EXPECT_TRUE(names(errorOf(task + "goal: 1\n"), {"task.yaml:5: ", "'goal'", "cut_disc"}));
  EXPECT_TRUE(names(errorOf("scene: a\nkind: dance\n"), {"task.yaml:2: ", "'kind'", "cut_disc", "lift"}));
  EXPECT_TRUE(names(errorOf("scene: a\nkind: lift\n"), {"task.yaml: ", "'lift' is missing"}));
  EXPECT_TRUE(names(errorOf("scene: a\nkind: lift\nlift: {up: [0, 0, 0]}\n"), {"'lift.up' must be a direction"}));
  EXPECT_TRUE(names(errorOf("scene: a\nkind: touch_targets\ntouch_targets: {}\n"), {"'touch_targets.targets'"}));
  EXPECT_TRUE(names(errorOf("scene: a\nkind: follow_line\nfollow_line: {path: [{}]}\n"), {"'follow_line.path'"}));
  EXPECT_TRUE(names(errorOf("scene: a\nkind: close_wound\n"), {"'close_wound' is missing"}));
  EXPECT_TRUE(names(errorOf("scene: a\nkind: clip_and_divide\n"), {"'clip_and_divide' is missing"}));
  EXPECT_TRUE(names(errorOf("scene: a\nkind: clip_and_divide\nclip_and_divide: {clips: [{}]}\n"),
                    {"'clip_and_divide.clips'", "even number"}));
  EXPECT_EQ(
      errorOf("scene: a\nkind: clip_and_divide\nclip_and_divide: {clips: [{}, {}, {}], divide_after: 2, part: duct}\n"),
      "");
  EXPECT_TRUE(
      names(errorOf("scene: a\nkind: clip_and_divide\nclip_and_divide: {clips: [{}, {}, {}], divide_after: 3}\n"),
            {"'clip_and_divide.divide_after'", "0 .. 2"}));
  EXPECT_TRUE(names(errorOf("scene: a\nkind: close_wound\nclose_wound: {path: [{}]}\n"), {"'close_wound.path'"}));
  EXPECT_TRUE(names(errorOf("scene: a\nkind: close_wound\nclose_wound: {knots: 0}\n"), {"task.yaml:3", "1 .. 64"}));
  EXPECT_TRUE(names(errorOf("kind: lift\nlift: {}\n"), {"task.yaml: ", "'scene' must name"}));
  EXPECT_TRUE(names(errorOf("scene: a\nmeasures:\n  - {measure: blood}\n"),
                    {"task.yaml:3: ", "'measures[0].measure'", "off_path_mm, deviation_mm"}));
  EXPECT_TRUE(names(errorOf(task + "pass_score: 301\n"), {"'pass_score' must be 0 .. 300"}));
  EXPECT_TRUE(names(errorOf("a: [\n"), {"task.yaml:2"}));
  EXPECT_TRUE(names(errorOf("7\n"), {"task.yaml: a task must be a map"}));
  EXPECT_TRUE(names(errorOf("scene: a\nkind: detach\n"), {"'detach' is missing"}));
  EXPECT_TRUE(names(errorOf("scene: a\nkind: expose\n"), {"'expose' is missing"}));
  EXPECT_TRUE(names(errorOf("scene: a\nkind: expose\nexpose: {}\n"), {"'expose.places' must be"}));
  EXPECT_TRUE(names(errorOf("scene: a\nkind: operation\n"), {"'operation' is missing"}));
  EXPECT_TRUE(names(errorOf("scene: a\nkind: operation\noperation: {stages: []}\n"), {"'operation.stages' must be"}));
  EXPECT_TRUE(names(errorOf("scene: a\nkind: operation\noperation: {stages: [{kind: lift}]}\n"),
                    {"'operation.stages[0]': 'lift' is missing"}));
  EXPECT_TRUE(names(errorOf("scene: a\nkind: operation\noperation: {stages: [{kind: operation}]}\n"),
                    {"'operation.stages[0].kind'", "detach"}));
}

TEST(TaskFile, KindsStandInTheOrderOfTheirGoals) {
  for (size_t i = 0; i < std::size(kTaskKinds); ++i) EXPECT_EQ(static_cast<size_t>(kTaskKinds[i].goal), i);
}

TEST(TaskFile, ScenesLieBesideTheTaskOrAreNames) {
  TaskConfig task;
  task.scene = "gauze";
  EXPECT_EQ(sceneOfTask(task, "/a/task.yaml"), "gauze");
  task.scene = "mine.yaml";
  EXPECT_EQ(sceneOfTask(task, "/a/task.yaml"), "/a/mine.yaml");
  task.scene = "/b/mine.yaml";
  EXPECT_EQ(sceneOfTask(task, "/a/task.yaml"), "/b/mine.yaml");
}

TEST(TaskFile, EveryShippedTaskIsRead) {
  size_t read = 0;
  for (const auto& entry : std::filesystem::directory_iterator(test::sourceFolder() + "/config/tasks")) {
    EXPECT_NO_THROW(loadTask(entry.path())) << entry.path();
    ++read;
  }
  EXPECT_GE(read, 5u);
}

}  // namespace
}  // namespace viscera
