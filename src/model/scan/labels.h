// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "model/scan/scan_source.h"

namespace viscera {

struct LabelOptions : ScanOptions {
  std::vector<std::string> labels;  ///< numbers or names, in the order that they get numbers in; none: all, by value
  std::string names_file;  ///< an ITK-SNAP table (.txt, .label) or a YAML map; empty: one beside the scan, if any
};

/// How far a voxel of a label map may be from a whole number: what slopes and resampling leave.
constexpr float kNearlyWhole = 1e-3F;

/// A label map of a byte a voxel: labels renumbered 1, 2, ... in the order asked for. Where labels of several layers
/// overlap, the first of that order has the voxel, which is noted.
/// @throws SceneError  naming the file, and the labels that it has
LabelVolume readLabels(const std::string& path, const LabelOptions& options = {});

/// What a file of names says: an ITK-SNAP table or a YAML map of numbers to names or names to numbers.
/// @throws SceneError  naming file and line
std::vector<LabelName> readLabelNames(const std::string& path);

}  // namespace viscera
