// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "tasks/verdict.h"

#include <algorithm>
#include <cmath>

#include "math/number_text.h"
#include "tasks/task_kinds.h"

namespace viscera {

namespace {

constexpr size_t kMistakes = 3;   // named by mistakesText()
constexpr double kNoLimit = 1e9;  // default of TaskRule::most
constexpr double kMmPerMetre = 1000;
constexpr double kPercent = 100;

std::string replaced(std::string text, const std::string& mark, const std::string& by) {
  const size_t at = text.find(mark);
  return at == std::string::npos ? text : text.replace(at, mark.size(), by);
}

std::string counted(size_t number, const std::string& noun) {
  return std::to_string(number) + " " + noun + (number == 1 ? "" : "s");
}

std::string lineText(const LineGoal& line) {
  return "cut " + plainNumber(kPercent * line.share) + " % of the line, within " +
         withUnit(kMmPerMetre * line.corridor_m, "mm") + " of it";
}

/// Returns a value with enough digits to differ from its limit.
std::string beyond(double value, double limit, const std::string& unit) {
  const std::string text = withUnit(value, unit);
  if (text != withUnit(limit, unit)) return text;
  return numberText(value, 9) + (unit.empty() ? "" : " " + unit);
}

std::string whyFailed(const TaskConfig& task, const TaskStatus& status) {
  if (!status.reached) {
    const bool late = status.time_s >= task.time_limit_s;
    return (late ? "the time limit of " + withUnit(task.time_limit_s, "s") + " was reached before the goal"
                 : status.step) +
           ". The goal was to " + goalText(task) + "; " + plainNumber(std::floor(kPercent * status.progress)) +
           " % of it was reached.";
  }
  std::string out;
  for (const TaskMeasure& measure : kTaskMeasures) {
    if (!isExceeded(task, status.tally, measure)) continue;
    const double most = *mostOf(task, measure), value = status.tally.*measure.value;
    out += (out.empty() ? "the limit of " : "; so was the limit of ") + withUnit(most, measure.unit) + " for " +
           phraseOf(task, measure) + (out.empty() ? " was exceeded (" : " (") + beyond(value, most, measure.unit) + ")";
  }
  return (out.empty() ? "the score is too low" : out) + ". The goal was reached in " + withUnit(status.time_s, "s") +
         ".";
}

}  // namespace

std::string plainNumber(double value) {
  if (std::abs(value) < 100) return numberText(value, 3);
  std::string out = fixedText(value, 1);
  if (out.size() > 2 && out.compare(out.size() - 2, 2, ".0") == 0) out.resize(out.size() - 2);
  return out;
}

std::string withUnit(double value, const std::string& unit) {
  return plainNumber(value) + (unit.empty() ? "" : " " + unit);
}

std::string phraseOf(const TaskConfig& task, const TaskMeasure& measure) {
  return replaced(replaced(measure.phrase, "%N", plainNumber(task.limits.force_n)), "%S",
                  plainNumber(task.limits.strain));
}

std::string goalText(const TaskConfig& task) {
  switch (task.kind) {
    case TaskGoal::kFollowLine:
      return lineText(task.line);
    case TaskGoal::kCutDisc:
      return "cut out the disc of " + withUnit(2 * kMmPerMetre * task.disc.radius_m, "mm");
    case TaskGoal::kTouchTargets:
      return "touch " + counted(task.touch.targets.size(), "target") + " in order";
    case TaskGoal::kLift:
      return "lift the tissue by " + withUnit(kMmPerMetre * task.lift.height_m, "mm") + " for " +
             withUnit(task.lift.hold_s, "s");
    case TaskGoal::kCloseWound:
      return lineText(task.close.line) + ", and close the wound with " +
             counted(static_cast<size_t>(task.close.knots), "knot");
    case TaskGoal::kClipDivide:
      return "set " + counted(task.clip.clips.size(), "clip") + " and divide the tissue between them";
    case TaskGoal::kDetach:
      return "cut the marked tissue free";
    case TaskGoal::kExpose:
      return "free " + counted(task.expose.places.size(), "marked place");
    case TaskGoal::kOperation: {
      std::string out;
      for (const TaskStage& stage : task.operation.stages)
        out += (out.empty() ? "" : "; then ") + goalText(stageOf(task, stage));
      return out;
    }
  }
  return "";
}

std::optional<double> mostOf(const TaskConfig& task, const TaskMeasure& measure) {
  std::optional<double> out;
  for (const TaskRule& rule : task.measures)
    if (rule.measure == measure.name && rule.most < kNoLimit) out = std::min(rule.most, out.value_or(kNoLimit));
  return out;
}

bool isExceeded(const TaskConfig& task, const TaskTally& tally, const TaskMeasure& measure) {
  const std::optional<double> most = mostOf(task, measure);
  return most && tally.*measure.value > *most;
}

std::string failedLimit(const TaskConfig& task, const TaskStatus& status) {
  if (status.state != TaskPhase::kFailed) return "";
  if (!status.reached && status.time_s >= task.time_limit_s) return "time_limit_s";
  for (const TaskRule& rule : task.measures)  // in the order in which the judge reads them
    for (const TaskMeasure& measure : kTaskMeasures)
      if (rule.measure == measure.name && (status.reached || rule.measure == kSparedCuts) &&
          isExceeded(task, status.tally, measure))
        return measure.name;
  return status.reached ? "pass_score" : "";
}

std::string verdictText(const TaskConfig& task, const TaskStatus& status) {
  const std::string why = status.state == TaskPhase::kPassed
                              ? "Passed: reached the goal (" + goalText(task) + ") in " + withUnit(status.time_s, "s") +
                                    " of at most " + withUnit(task.time_limit_s, "s") + "."
                              : "Failed: " + whyFailed(task, status);
  const std::string score = " Score " + plainNumber(status.score);
  return why + score + (task.pass_score > 0 ? "; " + plainNumber(task.pass_score) + " or more passes." : ".");
}

std::string mistakesText(const TaskConfig& task, const TaskStatus& status) {
  std::vector<std::pair<double, const TaskMeasure*>> costs;
  for (const TaskMeasure& measure : kTaskMeasures) {
    const double cost = costOf(task, status.tally, measure);
    if (cost > 0) costs.emplace_back(cost, &measure);
  }
  if (costs.empty()) return "No mistake cost points.";
  std::stable_sort(costs.begin(), costs.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::string out;
  for (size_t i = 0; i < std::min(kMistakes, costs.size()); ++i) {
    const TaskMeasure& measure = *costs[i].second;
    out += (out.empty() ? "Costliest mistakes: " : "; ") + plainNumber(costs[i].first) + " points for " +
           phraseOf(task, measure) + " (" + withUnit(status.tally.*measure.value, measure.unit) + ")";
  }
  return out + ".";
}

}  // namespace viscera
