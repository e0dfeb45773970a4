// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "model/scan/volume.h"

namespace viscera {

/// Values of a scan beside the borders of a label map that was made of it: what ValueWindow::value asks for. In memory
/// are eight bytes for each such voxel, and no others.
class BorderValues {
 public:
  /// Reads the scan once. @param first  voxel (0, 0, 0) of the map in the scan; the map may go beyond it
  BorderValues(SliceSource& source, const LabelVolume& map, const Vector3i& first);
  /// NaN where the scan has none, or the voxel is not beside a border.
  float at(size_t voxel) const;

 private:
  int row_size_;
  std::vector<size_t> rows_;  ///< [rows of the map + 1] first of its entries
  std::vector<int32_t> columns_;
  std::vector<float> values_;
};

}  // namespace viscera
