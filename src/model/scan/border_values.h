// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "model/scan/volume.h"

namespace viscera {

/// Values of a scan next to the borders of a label map that was made from it, for ValueWindow::value. It takes eight
/// bytes for each of these voxels.
class BorderValues {
 public:
  /// Reads the scan once. @param first  voxel of the scan that is voxel (0, 0, 0) of the map; the map may extend beyond
  /// the scan
  BorderValues(SliceSource& source, const LabelVolume& map, const Vector3i& first);
  /// Returns the value of a voxel; NaN where the scan has none, or the voxel is not next to a border.
  float at(size_t voxel) const;

 private:
  int row_size_;
  std::vector<size_t> rows_;  ///< [rows of the map + 1] index of the first entry of each row
  std::vector<int32_t> columns_;
  std::vector<float> values_;
};

}  // namespace viscera
