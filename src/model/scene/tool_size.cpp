// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scene/tool_size.h"

#include <algorithm>

#include "model/scene/within_ranges.h"

namespace viscera {

StylusConfig scaledTools(StylusConfig stylus, double scale, double cells) {
  for (const ToolSize& size : kToolSizes)
    size.of(stylus) *= size.meets_nodes ? std::max(scale, cells) : size.only_shrinks ? std::min(scale, 1.0) : scale;
  return withinRanges(stylus);
}

}  // namespace viscera
