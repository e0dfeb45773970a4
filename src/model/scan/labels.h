// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "model/scan/scan_source.h"

namespace viscera {

struct LabelOptions : ScanOptions {
  std::vector<std::string> labels;  ///< numbers or names, numbered in this order; none: all, by value
  std::string names_file;  ///< an ITK-SNAP table (.txt, .label) or a YAML map; empty: the file next to the scan, if
                           ///< there is one
};

/// Largest distance of a label map's value from an integer: the error of slopes and resampling.
constexpr float kNearlyWhole = 1e-3F;

/// Reads a label map with a byte per voxel: labels renumbered 1, 2, ... in the requested order. Where labels of several
/// layers overlap, the first of that order gets the voxel, with a note.
/// @throws SceneError  names the file, and the labels that it has
LabelVolume readLabels(const std::string& path, const LabelOptions& options = {});

/// Reads a file of names: an ITK-SNAP table or a YAML map of numbers to names or names to numbers.
/// @throws SceneError  names file and line
std::vector<LabelName> readLabelNames(const std::string& path);

}  // namespace viscera
