// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/contact/tool_boxes.h"

namespace viscera {

namespace {

Vector3f xyz(const layout::vec4& v) {
  return {v.x, v.y, v.z};
}

}  // namespace

ToolBoxes toolBoxes(const std::vector<layout::ToolMotion>& motions, float spacing_m) {
  ToolBoxes boxes;
  for (size_t s = 0; s < layout::kMaxStyluses; ++s) {
    const layout::ToolMotion &first = motions[s], &last = motions[motions.size() - layout::kMaxStyluses + s];
    if (first.info.y == 0) continue;
    Vector3f low = xyz(first.from).cwiseMin(xyz(last.to)), high = xyz(first.from).cwiseMax(xyz(last.to));
    float reach = first.from.w;
    if (first.info.y & (layout::kToolCuts | layout::kToolErases)) {
      low = low.cwiseMin(xyz(first.blade_from)).cwiseMin(xyz(last.blade_to));
      high = high.cwiseMax(xyz(first.blade_from)).cwiseMax(xyz(last.blade_to));
      reach = first.blade_from.w;
    }
    const Vector3f grown = Vector3f::Constant(reach + 2 * spacing_m);
    boxes.add({low - grown, high + grown});
  }
  return boxes;
}

}  // namespace viscera
