// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tasks/verdict.h"

#include <gtest/gtest.h>

#include "tasks/attempt.h"
#include "tasks/plot.h"
#include "tasks/progress.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

TaskConfig incision() {
  TaskConfig task;
  task.kind = TaskGoal::kFollowLine;
  task.time_limit_s = 60;
  task.pass_score = 30;
  task.limits.force_n = 1.5;
  task.measures = {{"off_path_mm", 1, 5}, {"force_s", 5, 1e9}, {"peak_force_n", 0, 3}};
  return task;
}

TaskStatus ended(TaskPhase state, double time_s, double score) {
  TaskStatus out;
  out.state = state;
  out.reached = true;
  out.progress = 1;
  out.time_s = time_s;
  out.score = score;
  return out;
}

TEST(Verdict, SaysThatATaskIsPassedAndWhatMistakesCost) {
  TaskStatus status = ended(TaskPhase::kPassed, 21.44, 32.5);
  status.tally.off_path_mm = 4.1;
  status.tally.force_s = 0.4;
  EXPECT_EQ(verdictText(incision(), status),
            "Passed: reached the goal (cut 95 % of the line, within 2 mm of it) in 21.4 s of at most 60 s. Score 32.5; "
            "30 or more passes.");
  EXPECT_EQ(mistakesText(incision(), status),
            "Costliest mistakes: 4.1 points for cutting outside the corridor (4.1 mm); 2 points for force above 1.5 N "
            "(0.4 s).");
  EXPECT_EQ(failedLimit(incision(), status), "");
  status.tally = {};
  EXPECT_EQ(mistakesText(incision(), status), "No mistake cost points.");
}

TEST(Verdict, NamesEveryLimitThatFailed) {
  TaskStatus status = ended(TaskPhase::kFailed, 20, 31);
  status.tally.off_path_mm = 5.0001;
  status.tally.peak_force_n = 4;
  EXPECT_EQ(
      verdictText(incision(), status),
      "Failed: the limit of 5 mm for cutting outside the corridor was exceeded (5.0001 mm); so was the limit of 3 N "
      "for the largest force (4 N). The goal was reached in 20 s. Score 31; 30 or more passes.");
  EXPECT_EQ(failedLimit(incision(), status), "off_path_mm");
  EXPECT_EQ(failedLimit(incision(), ended(TaskPhase::kFailed, 50, 10)), "pass_score");
  TaskStatus late = ended(TaskPhase::kFailed, 60, 0);
  late.reached = false;
  late.progress = 0.405;
  EXPECT_EQ(
      verdictText(incision(), late),
      "Failed: the time limit of 60 s was reached before the goal. The goal was to cut 95 % of the line, within 2 mm "
      "of it; 40 % of it was reached. Score 0; 30 or more passes.");
  EXPECT_EQ(failedLimit(incision(), late), "time_limit_s");
  late.time_s = 3;
  late.step = "the task was given up";
  EXPECT_EQ(verdictText(incision(), late).find("Failed: the task was given up. The goal was to "), 0u);
  EXPECT_EQ(failedLimit(incision(), late), "");
}

TEST(Verdict, PhrasesHaveTheLimitsOfTheTask) {
  for (const TaskMeasure& measure : kTaskMeasures) {
    const std::string phrase = phraseOf(incision(), measure);
    EXPECT_FALSE(phrase.empty()) << measure.name;
    EXPECT_EQ(phrase.find('%'), std::string::npos) << phrase;
  }
}

TEST(Attempt, DatesAreUtcAndNamesAreChecked) {
  const Attempt attempt = attemptAt(1767225600, "Ann");
  EXPECT_EQ(attempt.date, "2026-01-01T00:00:00Z");
  EXPECT_EQ(attempt.trainee, "Ann");
  EXPECT_TRUE(isUtcText(attempt.date));
  EXPECT_FALSE(isUtcText("2026-01-01 00:00:00Z"));
  EXPECT_FALSE(isUtcText("2026-01-01"));
  for (const char* name : {"Ann", "7", "\xc3\x89ve M.", "O'Neill, J. (2)"}) EXPECT_EQ(traineeFault(name), "") << name;
  for (const char* name : {"", " Ann", "-x", "=1", "@a", "a\tb", "a\xff", "a\xe2\x80\xae"})
    EXPECT_NE(traineeFault(name), "") << name;
  const std::string accent = "\xc3\xa9";
  std::string longest;
  for (int i = 0; i < kLongestTrainee; ++i) longest += accent;
  EXPECT_EQ(traineeFault(longest), "") << "characters, not bytes";
  EXPECT_NE(traineeFault(longest + accent), "");
}

TEST(Plot, TicksAreRoundAndFewEnough) {
  EXPECT_DOUBLE_EQ(tickStep(0, 10), 2);
  EXPECT_DOUBLE_EQ(tickStep(-30, 30), 20);
  EXPECT_DOUBLE_EQ(tickStep(0, 0.004), 0.001);
  for (const double high : {1e-9, 0.7, 3.0, 29.9, 1234.0}) {
    const PlotAxis axis = axisUpTo(high, "x");
    EXPECT_GE(axis.high, high * (1 - 1e-9));
    EXPECT_LE(axis.high / tickStep(0, axis.high), 9);
  }
  EXPECT_GT(axisUpTo(0, "x").high, 0);
}

TEST(Plot, LabelsAreWithinThePicture) {
  Plot plot({-0.00012, 0.00013, "x, m"}, {0, 123456, "<force>, N"}, 300, 100);
  plot.addLine({{0, 0}, {0.0001, 5}}, "#000", 1);
  const std::string svg = plot.svg();
  EXPECT_NE(svg.find("&lt;force&gt;, N"), std::string::npos);
  EXPECT_NE(svg.find(">100000<"), std::string::npos) << svg;
  EXPECT_EQ(svg.find("='-"), std::string::npos) << "nothing begins left of the picture or above it";
}

TEST(Progress, ReportsAreChecked) {
  const std::string good =
      R"({"task":"t","title":"","state":"passed","score":3,"pass_score":2,"time_s":1,"attempt":{"name":"","date":"2026-01-01T00:00:00Z"}})";
  EXPECT_EQ(readAttempt(good).score, 3);
  const auto error = [](const std::string& text) -> std::string {
    try {
      readAttempt(text);
    } catch (const Error& found) {
      return found.what();
    }
    return "";
  };
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    return text.replace(text.find(from), from.size(), to);
  };
  EXPECT_EQ(error("[]"), "is not a report of a task: it must be a map");
  EXPECT_EQ(error("nonsense"), "is not JSON");
  EXPECT_EQ(error(with("\"passed\"", "\"running\"")), "'state' must be passed or failed");
  EXPECT_EQ(error(with(":3", ":-3")), "'score' must be a number, 0 or more");
  EXPECT_EQ(error(with("\"time_s\"", "\"time\"")), "'time_s' is missing");
  EXPECT_NE(error(with("T00", " 00")), "");
  EXPECT_NE(error(with("\"name\":\"\"", "\"name\":\"\\u0007\"")), "");
}

}  // namespace
}  // namespace viscera
