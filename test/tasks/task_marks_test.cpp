// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tasks/task_marks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/source_folder.h"
#include "tasks/task.h"
#include "tasks/task_watch.h"
#include "viscera/session/session.h"

namespace viscera {
namespace {

constexpr double kRounding_m = 1e-12;

TEST(TaskMarks, ALineIsDividedByItsLengthAcrossTheNormal) {
  const std::vector<Vector3d> path = {{0, 0, 0}, {0.01, 0, 0.05}, {0.01, 0.02, 0}};
  const std::vector<MarkConfig> pieces = lineInPieces(path, Vector3d::UnitZ(), 4, 0.001);
  ASSERT_EQ(pieces.size(), 4U);
  EXPECT_NEAR((pieces[0].path.front().position_m - path[0]).norm(), 0, kRounding_m);
  EXPECT_NEAR((pieces[0].path.back().position_m - Vector3d(0.0075, 0, 0.0375)).norm(), 0, kRounding_m);
  ASSERT_EQ(pieces[1].path.size(), 3U) << "the corner is in the second piece";
  EXPECT_EQ(pieces[1].path[1].position_m, path[1]);
  EXPECT_EQ(pieces[1].path[0].position_m, pieces[0].path[1].position_m);
  EXPECT_NEAR((pieces[3].path.back().position_m - path[2]).norm(), 0, kRounding_m);
}

TEST(TaskMarks, StatesDifferInColourAndInPattern) {
  const std::vector<MarkState> states = {MarkState::kLater, MarkState::kNext, MarkState::kDone, MarkState::kWrong};
  const std::vector<MarkConfig> marks = styledMarks(std::vector<MarkConfig>(4), states);
  for (size_t i = 0; i < marks.size(); ++i) {
    for (size_t j = 0; j < i; ++j) {
      EXPECT_NE(marks[i].pattern, marks[j].pattern);
      EXPECT_GT((marks[i].color - marks[j].color).norm(), 0.3);
    }
  }
}

std::vector<MarkPattern> patternsOf(Session& session) {
  std::vector<MarkPattern> out;
  const Frame frame = session.drain();
  if (!frame.marks) return out;
  for (const MarkStyle& style : frame.marks->styles) out.push_back(style.pattern);
  return out;
}

/// Every shipped task shows marks on the tissue of its scene before it begins, and takes them away.
TEST(TaskMarks, OfShippedTasksAreOnTheTissue) {
  for (const char* name :
       {"incision", "pattern_cut", "touch_targets", "gentle_lift", "close_wound", "clip_and_divide"}) {
    SCOPED_TRACE(name);
    const std::string file = test::sourceFolder() + "/config/tasks/" + name + ".yaml";
    const TaskConfig task = loadTask(file);
    Session session(loadScene(test::sourceFolder() + "/config/scenes/" + task.scene + ".yaml", {"solver.backend=cpu"}));
    ASSERT_FALSE(session.drain().marks);
    {
      TaskWatch watch(session);
      session.recordTask(task.name, task.yaml);
      const Frame frame = session.drain();
      ASSERT_TRUE(frame.marks);
      std::vector<bool> shown(frame.marks->styles.size());
      for (const MarkStroke& stroke : *frame.marks->strokes) shown[stroke.mark] = true;
      EXPECT_TRUE(std::all_of(shown.begin(), shown.end(), [](bool is_shown) { return is_shown; }));
      const auto patterns = patternsOf(session);
      EXPECT_GT(std::count(patterns.begin(), patterns.end(), MarkPattern::kDashed), 0) << "nothing is next";
    }
    EXPECT_FALSE(session.drain().marks);
  }
}

constexpr double kPadTop_m = 0.01, kAbove_m = 0.03;
constexpr int kTicks = 60;  // to come down, and to go up

/// Returns the probe above the pad, or on it in the middle of a touch of 2 * kTicks.
StylusSamples touching(double x_m, int tick) {
  const double share = std::abs(1 - static_cast<double>(tick) / kTicks);
  StylusSamples samples;
  samples[0] = {true, {{x_m, 0, kPadTop_m + kAbove_m * share}, Quaterniond::Identity()}, false, false};
  return samples;
}

TEST(TaskMarks, TargetsAreLaterNextDoneOrWrong) {
  const std::string folder = test::sourceFolder() + "/config/";
  const TaskConfig task = loadTask(folder + "tasks/touch_targets.yaml");
  Session session(loadScene(folder + "scenes/" + task.scene + ".yaml", {"solver.backend=cpu"}));
  TaskWatch watch(session);
  session.recordTask(task.name, task.yaml);
  const auto later = MarkPattern::kThin, next = MarkPattern::kDashed, done = MarkPattern::kDouble,
             wrong = MarkPattern::kCrossed;
  EXPECT_EQ(patternsOf(session), (std::vector<MarkPattern>{next, later, later, later, later}));
  const auto touch = [&](double x_m) {
    for (int t = 0; t <= 2 * kTicks; ++t) session.step(touching(x_m, t), {});
  };
  touch(-0.03);
  EXPECT_EQ(patternsOf(session), (std::vector<MarkPattern>{done, next, later, later, later}));
  touch(0);
  EXPECT_EQ(patternsOf(session), (std::vector<MarkPattern>{done, next, later, later, wrong}));
  session.reset();
  EXPECT_EQ(patternsOf(session), (std::vector<MarkPattern>{next, later, later, later, later}));
}

}  // namespace
}  // namespace viscera
