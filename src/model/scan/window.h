// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "model/scan/volume.h"

namespace viscera {

/// What of a plain scan is taken for tissue: values within a window. That is no segmentation: what has the same values
/// and touches comes along (docs/scans.md).
struct WindowOptions {
  double low = 0, high = 0;  ///< both included; of CT in Hounsfield units, where the file has those
  double closing_mm = 0;     ///< gaps and holes narrower than twice that close; 0 .. 20
  int pieces = 1;            ///< so many of the largest pieces, joined by faces; 0: all
  double least_cm3 = 0;      ///< and only those of so much
  bool fill_holes = false;   ///< what tissue encloses is tissue
};

/// What was found on the way.
struct WindowReport {
  double least = 0, largest = 0;  ///< values of the scan
  uint64_t not_numbers = 0;       ///< voxels with NaN: outside of every window
  uint64_t in_window = 0;         ///< voxels
  uint64_t at_border = 0;         ///< of those, at the scan's border, which cuts them
  size_t pieces = 0, kept = 0;
  double kept_cm3 = 0, filled_cm3 = 0;
  std::vector<double> largest_cm3;    ///< of at most six pieces, the largest first
  Vector3i first = Vector3i::Zero();  ///< voxel (0, 0, 0) of what is returned, in the scan
};

/// Label 1 where tissue is, cropped to it with two voxels of nothing around. Reads the scan once; a byte a voxel is in
/// memory, and of distances as many slices as closing reaches over.
/// @throws SceneError  naming the file and its range of values: nothing is in the window, or no piece is large enough
LabelVolume windowed(SliceSource& source, const WindowOptions& options, WindowReport* report = nullptr);

}  // namespace viscera
