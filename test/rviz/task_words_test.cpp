// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/task_words.h"

#include <gtest/gtest.h>

#include "tasks/task_measures.h"

namespace viscera::rviz_plugin {
namespace {

std::vector<SentMeasure> all() {
  std::vector<SentMeasure> out;
  for (const TaskMeasure& measure : kTaskMeasures) out.push_back({measure.name, 0, 0});
  return out;
}

TEST(TaskWords, EveryMeasureHasWords) {
  for (const TaskMeasure& measure : kTaskMeasures) EXPECT_TRUE(hasWords(measure.name)) << measure.name;
  EXPECT_FALSE(measuresText("lift", all()).contains('_'));
}

TEST(TaskWords, OnlyMeasuresOfTheKindAreShown) {
  const QString lift = measuresText("lift", all());
  EXPECT_TRUE(lift.contains("Drops: 0")) << lift.toStdString();
  EXPECT_FALSE(lift.contains("corridor"));
  EXPECT_FALSE(lift.contains("knots"));
  EXPECT_FALSE(lift.contains("clip"));
  const QString line = measuresText("follow_line", all());
  EXPECT_TRUE(line.contains("Cut outside of the corridor: 0.0 mm")) << line.toStdString();
  EXPECT_FALSE(line.contains("Drops"));
}

TEST(TaskWords, WhatCostsIsShownOfEveryKind) {
  EXPECT_EQ(measuresText("lift", {{"gap_mm", 2, 3.5}}), "Gap of the wound: 2.0 mm, costs 3.5 s");
  EXPECT_EQ(measuresText("lift", {{"peak_force_n", 1.728, 0}}), "Largest force: 1.73 N");
}

TEST(TaskWords, OperationsShowWhatTheyHaveCounted) {
  EXPECT_FALSE(measuresText("operation", all()).contains("Drops"));
  EXPECT_EQ(measuresText("operation", {{"drops", 1, 0}, {"gap_mm", 0, 0}}), "Drops: 1");
}

TEST(TaskWords, BarOfTheScoreSaysFromWhereItPasses) {
  const ScoreBar passes = scoreBar(90, 60, 120), fails = scoreBar(30, 60, 120), lost = scoreBar(0, 0, 120);
  EXPECT_DOUBLE_EQ(passes.share, 0.75);
  EXPECT_DOUBLE_EQ(passes.pass_share, 0.5);
  EXPECT_TRUE(passes.passes);
  EXPECT_EQ(passes.text, "score 90.0, passes from 60.0");
  EXPECT_FALSE(fails.passes);
  EXPECT_FALSE(lost.passes);
  EXPECT_DOUBLE_EQ(scoreBar(5, 1, 0).share, 0);  // of a sender without a time limit
}

TEST(TaskWords, MeasureOfANewerSimulatorKeepsItsName) {
  EXPECT_EQ(measuresText("lift", {{"new_one", 1.5, 0}}), "new_one: 1.5");
}

}  // namespace
}  // namespace viscera::rviz_plugin
