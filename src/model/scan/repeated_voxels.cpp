// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scan/repeated_voxels.h"

#include <algorithm>
#include <numeric>

namespace viscera {
namespace {

constexpr int kMostTimes = 4;
constexpr int64_t kLeastBorders = 200;  ///< places where labels differ along an axis: fewer may coincide by chance
constexpr size_t kLeastPlanes = 3;      ///< number of planes that contain them: a box has two

/// Calls visit(index along the axis) for every place where the label differs from the previous one.
template <class Visit>
void forEachBorder(const LabelVolume& map, int axis, Visit visit) {
  const Vector3i& size = map.frame.size;
  const std::array<size_t, 3> strides = {1, static_cast<size_t>(size.x()), static_cast<size_t>(size.x()) * size.y()};
  size_t voxel = 0;
  for (int k = 0; k < size.z(); ++k)
    for (int j = 0; j < size.y(); ++j)
      for (int i = 0; i < size.x(); ++i, ++voxel) {
        const int at = axis == 0 ? i : axis == 1 ? j : k;
        if (at > 0 && map.labels[voxel] != map.labels[voxel - strides[static_cast<size_t>(axis)]]) visit(at);
      }
}

Repeats repeatsAlong(const LabelVolume& map, int axis) {
  std::vector<int64_t> borders(static_cast<size_t>(map.frame.size[axis]), 0);
  forEachBorder(map, axis, [&](int at) { ++borders[static_cast<size_t>(at)]; });
  const auto planes = borders.size() - static_cast<size_t>(std::count(borders.begin(), borders.end(), 0));
  if (planes < kLeastPlanes || std::accumulate(borders.begin(), borders.end(), int64_t{0}) < kLeastBorders) return {};
  const auto first = std::find_if(borders.begin(), borders.end(), [](int64_t n) { return n > 0; }) - borders.begin();
  for (int times = kMostTimes; times > 1; --times) {
    bool alike = true;
    for (size_t at = 0; at < borders.size(); ++at)
      alike = alike && (borders[at] == 0 || (static_cast<std::ptrdiff_t>(at) - first) % times == 0);
    if (alike) return {times, static_cast<int>(first % times)};
  }
  return {};
}

}  // namespace

std::array<Repeats, 3> repeatsOf(const LabelVolume& map) {
  return {repeatsAlong(map, 0), repeatsAlong(map, 1), repeatsAlong(map, 2)};
}

LabelVolume withoutRepeats(const LabelVolume& map, const std::array<Repeats, 3>& repeats) {
  LabelVolume out;
  out.names = map.names;
  out.frame = map.frame;
  Vector3i begin;  // start of the first voxel, which may be cut by the map's border
  for (int axis = 0; axis < 3; ++axis) {
    const Repeats& r = repeats[static_cast<size_t>(axis)];
    begin[axis] = r.first == 0 ? 0 : r.first - r.times;
    out.frame.size[axis] = (map.frame.size[axis] - begin[axis] + r.times - 1) / r.times;
    out.frame.origin += map.frame.axes.col(axis) * (begin[axis] + 0.5 * (r.times - 1));
    out.frame.axes.col(axis) *= r.times;
  }
  out.labels.reserve(out.frame.voxels());
  const auto from = [&](int axis, int n) {
    return std::max(0, begin[axis] + n * repeats[static_cast<size_t>(axis)].times);
  };
  for (int k = 0; k < out.frame.size.z(); ++k)
    for (int j = 0; j < out.frame.size.y(); ++j)
      for (int i = 0; i < out.frame.size.x(); ++i) {
        const size_t row = static_cast<size_t>(from(1, j)) + static_cast<size_t>(map.frame.size.y()) * from(2, k);
        out.labels.push_back(
            map.labels[static_cast<size_t>(from(0, i)) + static_cast<size_t>(map.frame.size.x()) * row]);
      }
  return out;
}

}  // namespace viscera
