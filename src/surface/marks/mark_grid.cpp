// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/marks/mark_grid.h"

#include <algorithm>
#include <cmath>

namespace viscera {

namespace {

constexpr float kReach = 6;        // farthest that shaders/draw/marks.glsl draws from a line, in half widths
constexpr float kStraight = 0.1F;  // of half the width: a piece may pass its points at this distance
constexpr float kMostCells = 48;   // along the longest side
constexpr float kLeastCell_m = 1e-4F;
constexpr uint32_t kMostInCell = 255;

struct Segment {
  Vector3f from, to;
  float reach_m;
};

/// Returns whether the points between two of a stroke are near the straight line between them.
bool isStraight(const MarkStroke& stroke, size_t first, size_t last) {
  const Vector3f from = stroke.points[first].rest_m, offset = stroke.points[last].rest_m - from;
  const float length2 = offset.squaredNorm();
  for (size_t i = first + 1; i < last; ++i) {
    const Vector3f to = stroke.points[i].rest_m - from;
    const float share = length2 > 0 ? std::clamp(to.dot(offset) / length2, 0.0F, 1.0F) : 0;
    if ((to - share * offset).norm() > kStraight * stroke.half_width_m) return false;
  }
  return true;
}

void addSegment(const MarkStroke& stroke, size_t first, size_t last, std::vector<Segment>& segments, MarkGrid& out) {
  const SkinPoint &a = stroke.points[first], &b = stroke.points[last];
  segments.push_back({a.rest_m, b.rest_m, kReach * stroke.half_width_m});
  out.segments.push_back({a.rest_m.x(), a.rest_m.y(), a.rest_m.z(), a.along_m});
  out.segments.push_back({b.rest_m.x(), b.rest_m.y(), b.rest_m.z(), stroke.half_width_m});
  out.segments.push_back({static_cast<float>(stroke.mark), static_cast<float>(stroke.patterns),
                          static_cast<float>(stroke.body), stroke.plain ? 1.0F : 0.0F});
}

/// Joins neighbouring pieces that are straight together.
std::vector<Segment> segmentsOf(const std::vector<MarkStroke>& strokes, MarkGrid& out) {
  constexpr size_t kMostJoined = 64;
  std::vector<Segment> segments;
  for (const MarkStroke& stroke : strokes) {
    if (stroke.points.size() == 1) addSegment(stroke, 0, 0, segments, out);
    for (size_t first = 0; first + 1 < stroke.points.size();) {
      size_t last = first + 1;
      while (last + 1 < stroke.points.size() && last - first < kMostJoined && isStraight(stroke, first, last + 1))
        ++last;
      addSegment(stroke, first, last, segments, out);
      first = last;
    }
  }
  return segments;
}

template <class Visit>
void forEachCell(const MarkGrid& grid, const Segment& segment, Visit visit) {
  std::array<uint32_t, 3> low{}, high{};
  for (size_t axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<Eigen::Index>(axis);
    const auto cell = [&](float at_m) {
      const float position = std::floor((at_m - grid.corner_m[k]) / grid.cell_m);
      return static_cast<uint32_t>(std::clamp(position, 0.0F, static_cast<float>(grid.counts[axis] - 1)));
    };
    low[axis] = cell(std::min(segment.from[k], segment.to[k]) - segment.reach_m);
    high[axis] = cell(std::max(segment.from[k], segment.to[k]) + segment.reach_m);
  }
  const Vector3f offset = segment.to - segment.from;
  const float length2 = offset.squaredNorm(), around_m = segment.reach_m + grid.cell_m * std::sqrt(0.75F);
  for (uint32_t z = low[2]; z <= high[2]; ++z) {
    for (uint32_t y = low[1]; y <= high[1]; ++y) {
      for (uint32_t x = low[0]; x <= high[0]; ++x) {
        const Vector3f of_cell(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F,
                               static_cast<float>(z) + 0.5F);
        const Vector3f to = grid.corner_m + grid.cell_m * of_cell - segment.from;
        const float share = length2 > 0 ? std::clamp(to.dot(offset) / length2, 0.0F, 1.0F) : 0;
        if ((to - share * offset).norm() <= around_m) visit(x + grid.counts[0] * (y + grid.counts[1] * z));
      }
    }
  }
}

}  // namespace

MarkGrid gridOf(const std::vector<MarkStroke>& strokes) {
  MarkGrid out;
  const std::vector<Segment> segments = segmentsOf(strokes, out);
  if (segments.empty()) return out;
  Eigen::AlignedBox3f box;
  float widest_m = 0;
  for (const Segment& segment : segments) {
    const Vector3f reach_m = Vector3f::Constant(segment.reach_m);
    for (const Vector3f& end : {segment.from, segment.to}) box.extend(end - reach_m), box.extend(end + reach_m);
    widest_m = std::max(widest_m, segment.reach_m);
  }
  out.corner_m = box.min();
  out.cell_m = std::max({box.sizes().maxCoeff() / kMostCells, widest_m / 2, kLeastCell_m});
  for (size_t axis = 0; axis < 3; ++axis) {
    const float length_m = box.sizes()[static_cast<Eigen::Index>(axis)];
    out.counts[axis] = static_cast<uint32_t>(std::max(1.0F, std::ceil(length_m / out.cell_m)));
  }
  std::vector<std::vector<uint32_t>> lists(size_t{out.counts[0]} * out.counts[1] * out.counts[2]);
  for (uint32_t i = 0; i < segments.size(); ++i) {
    forEachCell(out, segments[i], [&](uint32_t cell) {
      if (lists[cell].size() < kMostInCell) lists[cell].push_back(i);
    });
  }
  out.cells.resize(lists.size());
  for (size_t cell = 0; cell < lists.size(); ++cell) {
    out.cells[cell] = static_cast<uint32_t>(out.cells.size()) << 8 | static_cast<uint32_t>(lists[cell].size());
    out.cells.insert(out.cells.end(), lists[cell].begin(), lists[cell].end());
  }
  return out;
}

}  // namespace viscera
