// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/contact/tool_boxes.h"

namespace viscera {

namespace {

Vector3f xyzf(const layout::vec4& v) {
  return {v.x, v.y, v.z};
}

}  // namespace

ToolBoxes toolBoxes(const std::vector<layout::ToolMotion>& motions, float spacing_m) {
  ToolBoxes boxes;
  for (size_t s = 0; s < layout::kMaxStyluses; ++s) {
    const layout::ToolMotion &first = motions[s], &last = motions[motions.size() - layout::kMaxStyluses + s];
    if (first.info.y == 0) continue;
    Vector3f low = xyzf(first.from).cwiseMin(xyzf(last.to)), high = xyzf(first.from).cwiseMax(xyzf(last.to));
    float reach = first.from.w;
    if (first.info.y & (layout::kToolCuts | layout::kToolErases)) {
      low = low.cwiseMin(xyzf(first.blade_from)).cwiseMin(xyzf(last.blade_to));
      high = high.cwiseMax(xyzf(first.blade_from)).cwiseMax(xyzf(last.blade_to));
      reach = first.blade_from.w;
    }
    const Vector3f grown = Vector3f::Constant(reach + 2 * spacing_m);
    boxes.add({low - grown, high + grown});
  }
  return boxes;
}

}  // namespace viscera
