// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "viscera/math/types.h"

namespace viscera {

/// Positions of the voxels of a scan: voxel (i, j, k) has its centre at axes * (i, j, k) + origin. Axes may be sheared
/// and mirrored (det < 0), as files have them.
struct VolumeFrame {
  Vector3i size = Vector3i::Zero();  ///< number of voxels along i, j, k
  Matrix3d axes =
      Matrix3d::Identity();  ///< columns: steps of i, j, k [m], body axes of REP 103 (x anterior, y left, z up)
  Vector3d origin = Vector3d::Zero();  ///< centre of voxel (0, 0, 0) [m], same axes

  size_t voxels() const {
    return static_cast<size_t>(size.x()) * static_cast<size_t>(size.y()) * static_cast<size_t>(size.z());
  }
  Vector3d spacing_m() const { return axes.colwise().norm().transpose(); }
};

/// Name of a value of a label map.
struct LabelName {
  int64_t value = 0;                   ///< value in the file
  std::string name;                    ///< empty: the file has no name
  std::optional<Vector3d> color = {};  ///< sRGB, 0..1; without: the file has no colour
};

/// Label map with one label per voxel, 0 where there is none of the requested labels.
struct LabelVolume {
  VolumeFrame frame;
  std::vector<uint8_t> labels;   ///< [voxels] label, i fastest, then j, then k
  std::vector<LabelName> names;  ///< [largest label + 1] name of label n; names[0] is for outside
};

/// Scan that is read slice by slice, once. Only one slice is in memory.
class SliceSource {
 public:
  virtual ~SliceSource() = default;
  virtual const VolumeFrame& frame() const = 0;
  virtual const std::vector<LabelName>& names() const = 0;  ///< names in the file, by value
  /// Reads the next slice, k = 0 first. @param values  [size.x * size.y] i fastest; NaN where the file has NaN
  /// @throws SceneError  names the file: it ends early, or its data are corrupt
  virtual void next(std::vector<float>& values) = 0;
  /// Returns the file name, for errors; empty: not a file.
  virtual const std::string& file() const {
    static const std::string kNone;
    return kNone;
  }
};

}  // namespace viscera
