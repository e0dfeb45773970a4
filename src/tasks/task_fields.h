// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "model/scene/scene_fields.h"
#include "tasks/task.h"
#include "tasks/task_kinds.h"
#include "tasks/task_measures.h"

namespace viscera {

// The one list of a task's keys, for the visitors of field_ranges.h, which are to offer given(bool&) besides: is there
// such a map in the file?

constexpr Range kTaskSeconds{0, 86400};
constexpr Range kTaskWidth{1e-5, 1};      // m
constexpr double kMostTaskPlaces = 1000;  // of a path, or targets

template <class V>
void visitFields(V& v, TaskPlace& c) {
  v.vector("position_m", c.position_m, kCoordinate, "m", "of the tissue at rest, tissue frame");
}

template <class V>
void visitFields(V& v, LineGoal& c) {
  v.given(c.given);
  v.list("path", c.path, kMostTaskPlaces, "the line: straight from place to place, two at least");
  v.vector("normal", c.normal, kDirection, "", "of the plane in which distances from the line are measured");
  v.number("corridor_m", c.corridor_m, kTaskWidth, "m", "on either side of the line");
  v.number("share", c.share, {0.01, 1}, "1", "of the line that has to be cut");
}

template <class V>
void visitFields(V& v, DiscGoal& c) {
  v.given(c.given);
  v.vector("center_m", c.center_m, kCoordinate, "m", "of the tissue at rest, tissue frame");
  v.vector("normal", c.normal, kDirection, "", "of the disc's plane");
  v.number("radius_m", c.radius_m, {1e-4, 1}, "m", "of the circle to cut along");
  v.number("corridor_m", c.corridor_m, kTaskWidth, "m", "on either side of the circle");
}

template <class V>
void visitFields(V& v, TouchGoal& c) {
  v.given(c.given);
  v.list("targets", c.targets, kMostTaskPlaces, "in the order in which they are to be touched");
  v.number("radius_m", c.radius_m, kTaskWidth, "m", "of each");
}

template <class V>
void visitFields(V& v, LiftGoal& c) {
  v.given(c.given);
  v.vector("center_m", c.center_m, kCoordinate, "m", "where to take hold, of the tissue at rest");
  v.number("radius_m", c.radius_m, kTaskWidth, "m", "around it");
  v.vector("up", c.up, kDirection, "", "where to lift it");
  v.number("height_m", c.height_m, kTaskWidth, "m", "how far, from where it was taken");
  v.number("hold_s", c.hold_s, kTaskSeconds, "s", "how long it has to be that high");
}

template <class V>
void visitFields(V& v, CloseGoal& c) {
  visitFields(v, c.line);  // its keys are this group's
  v.given(c.given);
  v.number("reach_m", c.reach_m, kTaskWidth, "m", "how far on either side of the line the wound is looked at");
  v.number("gap_m", c.gap_m, kTaskWidth, "m", "how much farther apart its sides may be than at rest, on average");
  v.integer("knots", c.knots, {1, 64}, "that have to be tied");
  v.integer("throws", c.throws, {1, 8}, "that each needs, where hands throw it");
}

template <class V>
void visitFields(V& v, ClipGoal& c) {
  v.given(c.given);
  v.list("clips", c.clips, kMostTaskPlaces,
         "where clips are to be, an even number in their order along the tissue, which is to be divided in the middle");
  v.number("radius_m", c.radius_m, kTaskWidth, "m", "a clip that is no farther from a place is at it");
}

template <class V>
void visitFields(V& v, TaskLimits& c) {
  v.number("force_n", c.force_n, {0, 1000}, "N", "of any hand: time beyond it is the measure force_s");
  v.number("strain", c.strain, {0, 1000}, "1", "of any spring: time beyond it is the measure strain_s");
}

template <class V>
void visitFields(V& v, TaskRule& c) {
  std::vector<Choice<std::string>> names;
  for (const TaskMeasure& measure : kTaskMeasures) names.push_back({measure.name, measure.name});
  v.choice("measure", c.measure, names, "what is measured (second table)");
  v.number("cost_s", c.cost_s, {0, 1e6}, "s", "taken off the score for each unit of it");
  v.number("most", c.most, {0, 1e9}, "", "up to this the task is passed");
}

template <class V>
void visitFields(V& v, TaskConfig& c) {
  std::vector<Choice<TaskGoal>> kinds;
  for (const TaskKind& kind : kTaskKinds) kinds.push_back({kind.name, kind.goal});
  v.text("scene", c.scene, "name of a shipped scene, or a scene file beside this one");
  v.text("title", c.title, "one line");
  v.text("instructions", c.instructions, "what the trainee reads");
  v.choice("kind", c.kind, kinds, "what is to be done; the group of this name says where");
  v.number("time_limit_s", c.time_limit_s, {0.1, 86400}, "s", "simulated, from the first tick with a tracked hand on");
  v.number("proficiency_s", c.proficiency_s, kTaskSeconds, "s",
           "time of a proficient hand, for the report; 0: not known");
  v.number("pass_score", c.pass_score, kTaskSeconds, "s", "least score with which the task is passed");
  v.group("follow_line", c.line, "cut along a line, the blade within a corridor");
  v.group("cut_disc", c.disc, "cut out a disc: reached when nothing joins it to what is around");
  v.group("touch_targets", c.touch, "touch places one after another, and nothing else");
  v.group("lift", c.lift, "take hold of tissue, lift it and keep it there");
  v.group("close_wound", c.close, "open tissue along a line, tie the scene's threads, and let go");
  v.group("clip_and_divide", c.clip, "set clips at places of the tissue, and divide it between them");
  v.group("limits", c.limits, "beyond these, time is counted");
  v.list("measures", c.measures, 100, "what measures cost, and up to where the task is passed");
}

}  // namespace viscera
