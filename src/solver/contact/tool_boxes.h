// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "layout/awake_bricks.h"
#include "viscera/layout/limits.h"
#include "viscera/layout/tool_motion.h"
#include "viscera/math/types.h"

namespace viscera {

/// An axis-aligned box in the tissue frame [m].
struct ToolBox {
  Vector3f low, high;
};

/// List of at most one box per stylus and some for its shaft. It allocates nothing, as it is made in every tick.
class ToolBoxes {
 public:
  void add(const ToolBox& box) { boxes_[count_++] = box; }
  const ToolBox* begin() const { return boxes_.data(); }
  const ToolBox* end() const { return boxes_.data() + count_; }

 private:
  std::array<ToolBox, layout::kMostToolBoxes> boxes_;
  size_t count_ = 0;
};

/// Returns the regions that the tools may reach in a tick: a box per tip or blade that acts, and kShaftBoxes along each
/// shaft that tissue meets, as the box of all of a slanting shaft would hold much of an organ.
/// @param motions  those of kMaxStyluses, substep by substep   @param spacing_m  the largest of the bodies': the ends
/// of cut springs are up to a spring away from the blade
ToolBoxes toolBoxes(const std::vector<layout::ToolMotion>& motions, float spacing_m);

}  // namespace viscera
