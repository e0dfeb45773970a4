// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "model/scene/field_ranges.h"
#include "viscera/model/scene/mark_config.h"

namespace viscera {

// Scene keys of marks (scene_fields.h).

constexpr double kMostMarks = 1000, kMostMarkPoints = 1000;

template <class V>
void visitFields(V& v, MarkPoint& c) {
  v.vector("position_m", c.position_m, kCoordinate, "m",
           "position of the point at rest: tissue frame; of a tube: body's coordinates");
}

template <class V>
void visitFields(V& v, MarkConfig& c) {
  v.text("body", c.body, "name of the body; empty: the one with the nearest surface");
  v.choice("kind", c.kind,
           {{"line", MarkKind::kLine},
            {"circle", MarkKind::kCircle},
            {"ring", MarkKind::kRing},
            {"target", MarkKind::kTarget}},
           "kind of mark; line: through `path`; circle: on the surface; ring: around the body, where the plane of "
           "`center_m` and `normal` meets its surface; target: a circle with a dot");
  v.list("path", c.path, kMostMarkPoints, "line: points, straight between them; at least two");
  v.vector("center_m", c.center_m, kCoordinate, "m",
           "circle, ring and target: centre in the tissue at rest, tissue frame");
  v.vector("normal", c.normal, kDirection, "",
           "direction in which points are moved onto the surface that faces it; ring: normal of its plane; 0, 0, 0: "
           "points move to the nearest surface, and circles are parallel to it");
  v.number("radius_m", c.radius_m, {1e-4, 1}, "m",
           "circle and target: radius; ring: largest distance of the surface from the centre");
  v.number("width_m", c.width_m, {5e-5, 0.1}, "m", "width of its lines, without their dark borders");
  v.vector("color", c.color, {0, 1}, "1", "colour of the mark: red, green, blue");
  v.choice("pattern", c.pattern,
           {{"solid", MarkPattern::kSolid},
            {"dashed", MarkPattern::kDashed},
            {"double", MarkPattern::kDouble},
            {"crossed", MarkPattern::kCrossed},
            {"thin", MarkPattern::kThin}},
           "pattern of its lines");
}

}  // namespace viscera
