// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "model/scene/field_ranges.h"
#include "viscera/model/part_position.h"

namespace viscera {

// Keys of a position relative to a part, in strokes and tasks (scene_fields.h).

template <class V>
void visitFields(V& v, PartPosition& c) {
  v.given(c.given);
  v.text("part", c.part, "name of a part of the tissue, or of a body; of several pieces the largest counts");
  v.text("from", c.from, "name of the part at which `along` is 0; empty: the middle of the part, whatever `along` is");
  v.number("along", c.along, {0, 1}, "1", "share of the part's length, measured within the part");
  v.vector("offset_m", c.offset_m, kCoordinate, "m", "vector that is added, in the tissue frame");
}

}  // namespace viscera
