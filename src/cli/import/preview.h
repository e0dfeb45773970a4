// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <string>
#include <vector>

#include "model/scan/volume.h"
#include "viscera/model/shape/triangle_mesh.h"

namespace viscera {
struct Scene;
}

namespace viscera::cli {

/// Three slices of a volume, one along each pair of its axes, through one voxel.
struct ScanSlices {
  VolumeFrame frame;
  Vector3i at = Vector3i::Zero();
  std::array<std::vector<float>, 3> values;  ///< [axis that the slice does not have] the lower of its axes fastest
  bool labels = false;                       ///< values are numbers of organs, 1 and up; else grey

  bool empty() const { return values[2].empty(); }
};

/// Middle of the box of all labels, in the frame of the map [voxels].
Vector3d middleOf(const LabelVolume& map);
ScanSlices slicesOf(const LabelVolume& map);

/// Keeps the three slices through a voxel of what others read.
class SlicedSource : public SliceSource {
 public:
  /// @param at  a voxel of the source
  SlicedSource(SliceSource& source, const Vector3i& at);
  const VolumeFrame& frame() const override { return source_.frame(); }
  const std::vector<LabelName>& names() const override { return source_.names(); }
  const std::string& file() const override { return source_.file(); }
  void next(std::vector<float>& values) override;
  ScanSlices slices;

 private:
  SliceSource& source_;
  int read_ = 0;
};

/// The slices through a place of another scan; none if the place is not in it. Reads it once.
ScanSlices slicesAt(SliceSource& source, const Vector3d& place_m);

/// Writes front.png, left.png and above.png, surfaces from three sides, and slice_axial.png, slice_coronal.png and
/// slice_sagittal.png: borders of organs, each in its colour of the sides, over the scan, and in blue the outer borders
/// of the cells of their lattices.
/// @param organs  where the scan has them
/// @param scene   of these, moved alike
/// @param notes   get what is left out: the lattice of an organ that cannot be one
void writePreviews(const std::string& folder, const std::vector<const TriangleMesh*>& organs, const Scene& scene,
                   const ScanSlices& slices, std::vector<std::string>& notes);

}  // namespace viscera::cli
