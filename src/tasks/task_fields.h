// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "model/part_position_fields.h"
#include "model/scene/scene_fields.h"
#include "tasks/task.h"
#include "tasks/task_kinds.h"
#include "tasks/task_measures.h"

namespace viscera {

// The one list of a task's keys, for the visitors of field_ranges.h. These also need given(bool&): whether the file has
// this map.

constexpr Range kTaskSeconds{0, 86400};
constexpr Range kTaskWidth{1e-5, 1};         // m
constexpr double kMostTaskPositions = 1000;  // positions of a path, or targets

constexpr const char* kInstead = "position relative to a part (docs/user_guide.md#strokes)";

template <class V>
void visitFields(V& v, TaskPosition& c) {
  v.vector("position_m", c.position_m, kCoordinate, "m", "position in the tissue at rest, in the tissue frame");
  v.listedGroup("at", c.at, kInstead);
}

template <class V>
void visitFields(V& v, LineGoal& c) {
  v.given(c.given);
  v.list("path", c.path, kMostTaskPositions, "points of the line, straight between them; at least two");
  v.vector("normal", c.normal, kDirection, "", "normal of the plane in which distances from the line are measured");
  v.number("corridor_m", c.corridor_m, kTaskWidth, "m", "width of the corridor on either side of the line");
  v.number("share", c.share, {0.01, 1}, "1", "share of the line that has to be cut");
}

template <class V>
void visitFields(V& v, DiscGoal& c) {
  v.given(c.given);
  v.vector("center_m", c.center_m, kCoordinate, "m", "centre of the disc in the tissue at rest, in the tissue frame");
  v.vector("normal", c.normal, kDirection, "", "normal of the disc's plane");
  v.number("radius_m", c.radius_m, {1e-4, 1}, "m", "radius of the circle to cut along");
  v.number("corridor_m", c.corridor_m, kTaskWidth, "m", "width of the corridor on either side of the circle");
}

template <class V>
void visitFields(V& v, TouchGoal& c) {
  v.given(c.given);
  v.list("targets", c.targets, kMostTaskPositions, "targets, in the order in which they have to be touched");
  v.number("radius_m", c.radius_m, kTaskWidth, "m", "radius of each target");
}

template <class V>
void visitFields(V& v, LiftGoal& c) {
  v.given(c.given);
  v.vector("center_m", c.center_m, kCoordinate, "m", "position at which to grasp, in the tissue at rest");
  v.listedGroup("at", c.at, kInstead);
  v.number("radius_m", c.radius_m, kTaskWidth, "m", "radius around this position");
  v.vector("up", c.up, kDirection, "", "direction in which to lift");
  v.number("height_m", c.height_m, kTaskWidth, "m", "height to lift it to, from where it was grasped");
  v.number("hold_s", c.hold_s, kTaskSeconds, "s", "time for which it has to stay that high");
}

template <class V>
void visitFields(V& v, CloseGoal& c) {
  visitFields(v, c.line);  // its keys belong to this group
  v.given(c.given);
  v.number("reach_m", c.reach_m, kTaskWidth, "m",
           "distance from the line, on either side, at which the wound is measured");
  v.number("gap_m", c.gap_m, kTaskWidth, "m",
           "largest mean increase of the distance between the sides of the wound over that at rest");
  v.integer("knots", c.knots, {1, 64}, "number of knots that have to be tied");
  v.integer("throws", c.throws, {1, 8}, "number of throws that each knot needs, if a user throws it");
}

template <class V>
void visitFields(V& v, ClipGoal& c) {
  v.given(c.given);
  v.list("clips", c.clips, kMostTaskPositions, "positions of the clips, in their order along the tissue");
  v.integer("divide_after", c.divide_after, {0, kMostTaskPositions},
            "number of clips before the place where the tissue is to be divided; 0: half of them, of an even number");
  v.text(
      "part", c.part,
      "name of the part to be divided, where other tissue joins its ends: paths within this part alone count; empty: "
      "all paths");
  v.number("radius_m", c.radius_m, kTaskWidth, "m",
           "distance from a position within which a clip counts as placed there");
}

template <class V>
void visitFields(V& v, DetachGoal& c) {
  v.given(c.given);
  v.vector("position_m", c.position_m, kCoordinate, "m",
           "position in the tissue to be cut free, at rest, in the tissue frame");
  v.listedGroup("at", c.at, kInstead);
}

template <class V>
void visitFields(V& v, ExposeGoal& c) {
  v.given(c.given);
  v.list("places", c.places, kMostTaskPositions, "places at which the tissue has to be freed");
  v.number("radius_m", c.radius_m, kTaskWidth, "m", "radius around each place, at rest");
  v.number("share", c.share, {0.01, 1}, "1", "share of the area of attachments there that has to be parted");
}

/// Returns the choices of kinds. @param of_stages  without operation
inline std::vector<Choice<TaskGoal>> kindChoices(bool of_stages) {
  std::vector<Choice<TaskGoal>> out;
  for (const TaskKind& kind : kTaskKinds)
    if (!of_stages || kind.goal != TaskGoal::kOperation) out.push_back({kind.name, kind.goal});
  return out;
}

template <class V>
void visitFields(V& v, TaskStage& c) {
  v.text("title", c.title, "title of the stage, before what the trainee has to do");
  v.choice("kind", c.kind, kindChoices(true), "kind of the stage; the group of this name gives its goal");
  constexpr const char* kAsAbove = "goal, with the keys of this group of a task";
  v.listedGroup("follow_line", c.line, kAsAbove);
  v.listedGroup("cut_disc", c.disc, kAsAbove);
  v.listedGroup("touch_targets", c.touch, kAsAbove);
  v.listedGroup("lift", c.lift, kAsAbove);
  v.listedGroup("close_wound", c.close, kAsAbove);
  v.listedGroup("clip_and_divide", c.clip, kAsAbove);
  v.listedGroup("detach", c.detach, kAsAbove);
  v.listedGroup("expose", c.expose, kAsAbove);
}

template <class V>
void visitFields(V& v, OperationGoal& c) {
  v.given(c.given);
  v.list("stages", c.stages, 32, "stages, in the order in which their goals have to be reached");
}

template <class V>
void visitFields(V& v, TaskLimits& c) {
  v.number("force_n", c.force_n, {0, 1000}, "N",
           "force on any stylus above which time is counted, as the measure force_s");
  v.number("strain", c.strain, {0, 1000}, "1",
           "strain of any spring above which time is counted, as the measure strain_s");
}

template <class V>
void visitFields(V& v, TaskRule& c) {
  std::vector<Choice<std::string>> names;
  for (const TaskMeasure& measure : kTaskMeasures) names.push_back({measure.name, measure.name});
  v.choice("measure", c.measure, names, "name of the measure (second table)");
  v.number("cost_s", c.cost_s, {0, 1e6}, "s", "penalty per unit of the measure, subtracted from the score");
  v.number("most", c.most, {0, 1e9}, "", "largest value with which the task is passed");
}

template <class V>
void visitFields(V& v, TaskConfig& c) {
  v.text("scene", c.scene, "name of a shipped scene, or of a scene file next to this one");
  v.text("title", c.title, "title, one line");
  v.text("instructions", c.instructions, "instructions that the trainee reads");
  v.choice("kind", c.kind, kindChoices(false), "kind of task; the group of this name gives its goal");
  v.number("time_limit_s", c.time_limit_s, {0.1, 86400}, "s",
           "limit of simulated time, from the first tick with a tracked stylus");
  v.number("proficiency_s", c.proficiency_s, kTaskSeconds, "s",
           "time of a proficient user, for the report; 0: not known");
  v.number("pass_score", c.pass_score, kTaskSeconds, "s", "lowest score that passes the task");
  v.group("follow_line", c.line, "goal: cut along a line, with the blade within a corridor");
  v.group("cut_disc", c.disc, "goal: cut out a disc; reached when nothing connects it to the tissue around it");
  v.group("touch_targets", c.touch, "goal: touch positions one after another, and nothing else");
  v.group("lift", c.lift, "goal: grasp tissue, lift it and keep it there");
  v.group("close_wound", c.close, "goal: open tissue along a line, tie the scene's sutures, and let go");
  v.group("clip_and_divide", c.clip, "goal: set clips at positions of the tissue, and divide it between them");
  v.group("detach", c.detach, "goal: cut until nothing connects the tissue at a position to tissue that is held");
  v.group("expose", c.expose, "goal: part the attachments (`attachments[]`) around places");
  v.group("operation", c.operation, "goal: reach the goals of stages, one after another");
  v.texts("spared_parts", c.spared_parts, 64,
          "names of parts or bodies that must not be cut; the measure spared_cuts counts their cuts");
  v.group("limits", c.limits, "limits above which time is counted");
  v.list("measures", c.measures, 100, "costs of measures, and the values with which the task is passed");
}

}  // namespace viscera
