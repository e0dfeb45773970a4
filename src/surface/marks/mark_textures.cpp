// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/marks/mark_textures.h"

#include <algorithm>

#include "layout/seen.h"
#include "math/srgb.h"
#include "surface/marks/mark_grid.h"

namespace viscera {

void MarkTextures::show(const std::shared_ptr<const VisibleMarks>& marks) {
  if (marks == marks_) return;
  marks_ = marks;
  any_ = marks != nullptr && !marks->strokes->empty();
  if (!any_) return;
  if (marks->strokes != strokes_) {
    strokes_ = marks->strokes;
    const MarkGrid grid = gridOf(*strokes_);
    segments_ = gpu::Buffer<layout::vec4>(grid.segments, "mark segments");
    cells_ = gpu::Buffer<uint32_t>(grid.cells, "mark cells");
    segments_view_ = gpu::TexelView(segments_.raw(), gpu::TexelFormat::kRgba32f);
    cells_view_ = gpu::TexelView(cells_.raw(), gpu::TexelFormat::kR32ui);
    space_ = {grid.corner_m.x(), grid.corner_m.y(), grid.corner_m.z(), 1 / grid.cell_m};
    for (size_t axis = 0; axis < 3; ++axis) counts_[axis] = static_cast<float>(grid.counts[axis]);
  }
  std::vector<layout::vec4> styles;
  for (const MarkStyle& style : marks->styles) {
    const Vector3f color = style.color.cast<double>().unaryExpr(&linearFromSrgb).cast<float>();
    styles.push_back({color.x(), color.y(), color.z(), static_cast<float>(style.pattern)});
  }
  if (styles.size() > styles_.size()) {
    styles_ = gpu::Buffer<layout::vec4>(styles, "mark styles");
    styles_view_ = gpu::TexelView(styles_.raw(), gpu::TexelFormat::kRgba32f);
  } else {
    styles_.write(styles);
  }
}

void MarkTextures::bind() const {
  segments_view_.bind(layout::kUnitMarkSegments);
  styles_view_.bind(layout::kUnitMarkStyles);
  cells_view_.bind(layout::kUnitMarkCells);
}

void MarkTextures::set(const gpu::Program& program) const {
  constexpr std::array<float, 3> kNone{};
  program.setVectors("mark_space", space_.data(), 4, 1);
  program.setVectors("mark_counts", (any_ ? counts_ : kNone).data(), 3, 1);
}

}  // namespace viscera
