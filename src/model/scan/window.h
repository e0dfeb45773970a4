// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "model/scan/volume.h"

namespace viscera {

/// Tissue of a plain scan: voxels with values within a window. This is no segmentation: anything with the same values
/// that touches tissue is included (docs/scans.md).
struct WindowOptions {
  double low = 0, high = 0;  ///< bounds, both inclusive; in Hounsfield units for CT, where the file has those
  double closing_mm = 0;     ///< gaps and holes narrower than twice this are closed [mm]; 0 .. 20
  int pieces = 1;            ///< number of largest pieces to keep, joined by faces; 0: all
  double least_cm3 = 0;      ///< smallest volume of a piece to keep [cm3]
  bool fill_holes = false;   ///< cavities enclosed by tissue become tissue
};

/// Statistics of a scan and its window.
struct WindowReport {
  double least = 0, largest = 0;  ///< range of the values of the scan
  uint64_t not_numbers = 0;       ///< voxels with NaN: outside every window
  uint64_t in_window = 0;         ///< voxels within the window
  uint64_t at_border = 0;         ///< voxels within the window at the scan's border, which cuts the tissue
  size_t pieces = 0, kept = 0;
  double kept_cm3 = 0, filled_cm3 = 0;
  std::vector<double> largest_cm3;    ///< of at most six pieces, the largest first [cm3]
  Vector3i first = Vector3i::Zero();  ///< voxel of the scan that is voxel (0, 0, 0) of the result
};

/// Returns label 1 where tissue is, cropped to it with two empty voxels around. Reads the scan once. In memory it keeps
/// a byte per voxel, and distances of as many slices as closing reaches over.
/// @throws SceneError  names the file and its range of values: nothing is in the window, or no piece is large enough
LabelVolume windowed(SliceSource& source, const WindowOptions& options, WindowReport* report = nullptr);

}  // namespace viscera
