// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "viscera/layout/limits.h"
#include "viscera/layout/tool_motion.h"
#include "viscera/math/types.h"

namespace viscera {

/// A box in the tissue frame [m].
struct ToolBox {
  Vector3f low, high;
};

/// At most one per stylus; nothing is allocated, as every tick asks.
class ToolBoxes {
 public:
  void add(const ToolBox& box) { boxes_[count_++] = box; }
  const ToolBox* begin() const { return boxes_.data(); }
  const ToolBox* end() const { return boxes_.data() + count_; }

 private:
  std::array<ToolBox, layout::kMaxStyluses> boxes_;
  size_t count_ = 0;
};

/// Where the tools may reach in a tick, whose motions are substep by substep those of kMaxStyluses: one box per tool
/// that acts. @param spacing_m  the largest of the bodies': the ends of springs that are cut lie up to a spring beside
/// the blade
ToolBoxes toolBoxes(const std::vector<layout::ToolMotion>& motions, float spacing_m);

}  // namespace viscera
