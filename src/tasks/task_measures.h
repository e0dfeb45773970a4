// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace viscera {

/// What is counted while a task runs.
struct TaskTally {
  double off_path_mm = 0, deviation_mm = 0;
  double wrong_touches = 0, drops = 0;
  double gap_mm = 0, weak_knots = 0;
  double clip_off_mm = 0, bad_clips = 0;
  double blood_ml = 0;
  double force_s = 0, peak_force_n = 0;
  double strain_s = 0, peak_strain = 0;
  double path_m = 0;
};

/// A measure of a task: what rules (TaskRule) may name.
struct TaskMeasure {
  const char* name;
  const char* meaning;
  double TaskTally::*value;
};

inline constexpr TaskMeasure kTaskMeasures[] = {
    {"off_path_mm",
     "mm: way of the tip of a blade or cautery in ticks in which springs were cut, by the share of cut points out of "
     "the corridor",
     &TaskTally::off_path_mm},
    {"deviation_mm", "mm: largest distance of a cut point from the line", &TaskTally::deviation_mm},
    {"wrong_touches", "contacts that begin anywhere but at the target that is due", &TaskTally::wrong_touches},
    {"drops", "times that lifted tissue was lost before the goal was reached", &TaskTally::drops},
    {"gap_mm", "mm: how much farther apart the sides of the wound are than at rest, now", &TaskTally::gap_mm},
    {"weak_knots", "tied knots that are neither square nor surgeon's", &TaskTally::weak_knots},
    {"clip_off_mm", "mm: largest distance of a clip, of those at their places, from its place, at rest",
     &TaskTally::clip_off_mm},
    {"bad_clips", "clips at no place or at one that has a clip, that closed on nothing, or were taken off",
     &TaskTally::bad_clips},
    {"blood_ml", "ml: what has run out of vessels (bleeding.flow_ml_per_min)", &TaskTally::blood_ml},
    {"force_s", "s in which a hand felt more than limits.force_n", &TaskTally::force_s},
    {"peak_force_n", "N: largest force on any hand", &TaskTally::peak_force_n},
    {"strain_s", "s in which a spring was strained more than limits.strain", &TaskTally::strain_s},
    {"peak_strain", "largest strain of a spring", &TaskTally::peak_strain},
    {"path_m", "m: ways of all tips together", &TaskTally::path_m},
};

}  // namespace viscera
