// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "rviz/task_words.h"

#include <algorithm>
#include <array>
#include <iterator>

namespace viscera::rviz_plugin {
namespace {

using Kinds = std::array<const char*, 3>;

struct MeasureWords {
  const char* name;
  const char* words;
  const char* unit;  ///< unit with a space before it
  int digits;        ///< number of decimals
  Kinds kinds{};     ///< kinds of tasks that have it; empty: all
};

const MeasureWords kWords[] = {
    {"off_path_mm", "Cut outside of the corridor", " mm", 1, {"follow_line", "cut_disc", "close_wound"}},
    {"deviation_mm", "Largest distance from the line", " mm", 1, {"follow_line", "cut_disc", "close_wound"}},
    {"wrong_touches", "Touches at a wrong place", "", 0, {"touch_targets"}},
    {"drops", "Drops", "", 0, {"lift"}},
    {"gap_mm", "Gap of the wound", " mm", 1, {"close_wound"}},
    {"weak_knots", "Weak knots", "", 0, {"close_wound"}},
    {"clip_off_mm", "Largest distance of a clip from its place", " mm", 1, {"clip_and_divide"}},
    {"bad_clips", "Misplaced clips", "", 0, {"clip_and_divide"}},
    {"blood_ml", "Blood lost", " ml", 1, {"clip_and_divide", "operation"}},
    {"bile_ml", "Bile spilt", " ml", 1, {"operation"}},
    {"spared_cuts", "Cuts in tissue to be spared", "", 0, {"operation"}},
    {"force_s", "Time above the force limit", " s", 1},
    {"peak_force_n", "Largest force", " N", 2},
    {"strain_s", "Time above the strain limit", " s", 1},
    {"peak_strain", "Largest strain", "", 2},
    {"path_m", "Path of all tips", " m", 2},
};

const MeasureWords* wordsOf(const std::string& measure) {
  const auto found = std::find_if(std::begin(kWords), std::end(kWords),
                                  [&](const MeasureWords& words) { return measure == words.name; });
  return found == std::end(kWords) ? nullptr : found;
}

bool isOf(const MeasureWords& words, const std::string& kind) {
  return !words.kinds[0] ||
         std::any_of(words.kinds.begin(), words.kinds.end(), [&](const char* name) { return name && kind == name; });
}

}  // namespace

bool hasWords(const std::string& measure) {
  return wordsOf(measure) != nullptr;
}

QString measuresText(const std::string& kind, const std::vector<SentMeasure>& measures) {
  QString out;
  for (const SentMeasure& measure : measures) {
    const MeasureWords* const words = wordsOf(measure.name);
    if (words && !isOf(*words, kind) && measure.value == 0 && measure.cost_s <= 0) continue;
    out += words ? QString(words->words) + ": " + QString::number(measure.value, 'f', words->digits) + words->unit
                 : QString::fromStdString(measure.name) + ": " + QString::number(measure.value, 'g', 4);
    if (measure.cost_s > 0) out += ", costs " + QString::number(measure.cost_s, 'f', 1) + " s";
    out += "\n";
  }
  return out.trimmed();
}

ScoreBar scoreBar(double score, double pass_score, double most) {
  const auto share = [most](double of) { return most > 0 ? std::clamp(of / most, 0.0, 1.0) : 0.0; };
  return {share(score), share(pass_score), score > 0 && score >= pass_score,
          "score " + QString::number(score, 'f', 1) + ", passes from " + QString::number(pass_score, 'f', 1)};
}

}  // namespace viscera::rviz_plugin
