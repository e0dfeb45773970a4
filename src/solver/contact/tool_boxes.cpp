// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/contact/tool_boxes.h"

namespace viscera {

namespace {

Vector3f xyzf(const layout::vec4& v) {
  return {v.x, v.y, v.z};
}

void addShaft(const layout::ToolMotion& first, const layout::ToolMotion& last, float spacing_m, ToolBoxes& boxes) {
  const Vector3f ends[4] = {xyzf(first.shaft_from), xyzf(first.shaft_far_from), xyzf(last.shaft_to),
                            xyzf(last.shaft_far_to)};
  const Vector3f grown = Vector3f::Constant(first.shaft_from.w + 2 * spacing_m);
  const auto along = [&](size_t from, float share) -> Vector3f {
    return ends[from] + share * (ends[from + 1] - ends[from]);
  };
  for (size_t i = 0; i < layout::kShaftBoxes; ++i) {
    const float near = static_cast<float>(i) / layout::kShaftBoxes,
                far = static_cast<float>(i + 1) / layout::kShaftBoxes;
    const Vector3f corners[4] = {along(0, near), along(0, far), along(2, near), along(2, far)};
    Vector3f low = corners[0], high = corners[0];
    for (const Vector3f& corner : corners) {
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
    boxes.add({low - grown, high + grown});
  }
}

}  // namespace

ToolBoxes toolBoxes(const std::vector<layout::ToolMotion>& motions, float spacing_m) {
  ToolBoxes boxes;
  for (size_t s = 0; s < layout::kMaxStyluses; ++s) {
    const layout::ToolMotion &first = motions[s], &last = motions[motions.size() - layout::kMaxStyluses + s];
    if (first.info.y & layout::kToolShaft) addShaft(first, last, spacing_m, boxes);
    if ((first.info.y & ~(layout::kToolShaft | layout::kToolFeels)) == 0) continue;
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
