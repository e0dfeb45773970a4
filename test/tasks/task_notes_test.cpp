// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tasks/task_notes.h"

#include <gtest/gtest.h>

namespace viscera {
namespace {

TEST(TaskNotes, SayWhichMeasuresAKindDoesNotCount) {
  TaskConfig task;
  task.kind = TaskGoal::kLift;
  task.measures = {{"drops", 1, 3}, {"peak_force_n", 1, 3}, {"gap_mm", 1, 3}};
  const std::vector<std::string> notes = taskNotes(task);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("measure gap_mm is always 0 in a task of kind lift, which measures drops, "),
            std::string::npos)
      << notes[0];
  task.kind = TaskGoal::kCloseWound;
  task.measures = {{"gap_mm", 1, 3}, {"off_path_mm", 1, 3}};
  EXPECT_TRUE(taskNotes(task).empty());
}

}  // namespace
}  // namespace viscera
