// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scan/border_values.h"

#include <algorithm>
#include <limits>

namespace viscera {
namespace {

/// Returns whether a neighbour along an axis has another label; neighbours beyond the map do not count.
bool besideBorder(const LabelVolume& map, const Vector3i& voxel, size_t index) {
  size_t stride = 1;
  for (int axis = 0; axis < 3; ++axis) {
    if (voxel[axis] > 0 && map.labels[index - stride] != map.labels[index]) return true;
    if (voxel[axis] + 1 < map.frame.size[axis] && map.labels[index + stride] != map.labels[index]) return true;
    stride *= static_cast<size_t>(map.frame.size[axis]);
  }
  return false;
}

}  // namespace

BorderValues::BorderValues(SliceSource& source, const LabelVolume& map, const Vector3i& first)
    : row_size_(map.frame.size.x()), rows_(1, 0) {
  const Vector3i size = map.frame.size, scan = source.frame().size;
  rows_.resize(static_cast<size_t>(size.y()) * static_cast<size_t>(size.z()) + 1, 0);
  std::vector<float> slice;
  size_t row = 0;
  for (int k = std::min(0, first.z()); k < scan.z(); ++k) {
    if (k >= 0) source.next(slice);  // reads to the end, as the end of a file has its checksum
    if (k < first.z() || k >= first.z() + size.z()) continue;
    for (int j = first.y(); j < first.y() + size.y(); ++j, ++row) {
      if (k >= 0 && j >= 0 && j < scan.y())
        for (int i = std::max(0, first.x()); i < std::min(scan.x(), first.x() + size.x()); ++i) {
          const Vector3i voxel = Vector3i(i, j, k) - first;
          const size_t index = row * static_cast<size_t>(size.x()) + static_cast<size_t>(voxel.x());
          if (!besideBorder(map, voxel, index)) continue;
          columns_.push_back(voxel.x());
          values_.push_back(slice[static_cast<size_t>(i) + static_cast<size_t>(scan.x()) * static_cast<size_t>(j)]);
        }
      rows_[row + 1] = values_.size();
    }
  }
  for (; row + 1 < rows_.size(); ++row) rows_[row + 1] = values_.size();
}

float BorderValues::at(size_t voxel) const {
  const size_t row = voxel / static_cast<size_t>(row_size_);
  const auto column = static_cast<int32_t>(voxel % static_cast<size_t>(row_size_));
  const auto begin = columns_.begin() + static_cast<std::ptrdiff_t>(rows_[row]),
             end = columns_.begin() + static_cast<std::ptrdiff_t>(rows_[row + 1]);
  const auto found = std::lower_bound(begin, end, column);
  if (found == end || *found != column) return std::numeric_limits<float>::quiet_NaN();
  return values_[static_cast<size_t>(found - columns_.begin())];
}

}  // namespace viscera
