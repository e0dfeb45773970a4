// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace viscera {

/// Measures that are counted while a task runs.
struct TaskTally {
  double off_path_mm = 0, deviation_mm = 0;
  double wrong_touches = 0, drops = 0;
  double gap_mm = 0, weak_knots = 0;
  double clip_off_mm = 0, bad_clips = 0;
  double blood_ml = 0, bile_ml = 0;
  double spared_cuts = 0;
  double force_s = 0, peak_force_n = 0;
  double strain_s = 0, peak_strain = 0;
  double path_m = 0;
};

/// A measure of a task, which rules (TaskRule) refer to by name.
struct TaskMeasure {
  const char* name;
  const char* meaning;
  double TaskTally::*value;
  const char* unit;    ///< empty: a number of events, or a ratio
  const char* phrase;  ///< noun for sentences; %N and %S are limits.force_n and limits.strain
};

/// Measure that ends a task as soon as it is exceeded.
constexpr std::string_view kSparedCuts = "spared_cuts";

inline constexpr TaskMeasure kTaskMeasures[] = {
    {"off_path_mm",
     "mm: path length of the tip of a blade or cautery in ticks in which springs were cut, times the share of cut "
     "points outside the corridor",
     &TaskTally::off_path_mm, "mm", "cutting outside the corridor"},
    {"deviation_mm", "mm: largest distance of a cut point from the line", &TaskTally::deviation_mm, "mm",
     "the largest distance from the line"},
    {"wrong_touches", "contacts that begin anywhere but at the target that is due", &TaskTally::wrong_touches, "",
     "wrong touches"},
    {"drops", "times that lifted tissue was lost before the goal was reached", &TaskTally::drops, "", "dropped tissue"},
    {"gap_mm", "mm: current mean increase of the distance between the sides of the wound over that at rest",
     &TaskTally::gap_mm, "mm", "the gap of the wound"},
    {"weak_knots", "tied knots that are neither square nor surgeon's", &TaskTally::weak_knots, "", "weak knots"},
    {"clip_off_mm", "mm: largest distance at rest between a clip that is placed and its position",
     &TaskTally::clip_off_mm, "mm", "the distance of clips from their positions"},
    {"bad_clips",
     "clips at no position or at one that has a clip, clips that closed on nothing, and clips that were taken off",
     &TaskTally::bad_clips, "", "bad clips"},
    {"blood_ml", "ml: blood that has flowed out of vessels (bleeding.flow_ml_per_min)", &TaskTally::blood_ml, "ml",
     "blood loss"},
    {"bile_ml", "ml: bile that has flowed out of parts with bleeding.fluid bile", &TaskTally::bile_ml, "ml",
     "spilt bile"},
    {"spared_cuts", "springs that were cut in `spared_parts`", &TaskTally::spared_cuts, "",
     "cuts in tissue to be spared"},
    {"force_s", "s: time in which the force on a stylus was above limits.force_n", &TaskTally::force_s, "s",
     "force above %N N"},
    {"peak_force_n", "N: largest force on any stylus", &TaskTally::peak_force_n, "N", "the largest force"},
    {"strain_s", "s: time in which the strain of a spring was above limits.strain", &TaskTally::strain_s, "s",
     "strain above %S"},
    {"peak_strain", "largest strain of a spring", &TaskTally::peak_strain, "", "the largest strain"},
    {"path_m", "m: total path length of all tips", &TaskTally::path_m, "m", "the path of the tips"},
};

}  // namespace viscera
