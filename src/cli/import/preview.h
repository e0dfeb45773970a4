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

/// Three slices of a volume through one voxel, one along each pair of axes.
struct ScanSlices {
  VolumeFrame frame;
  Vector3i at = Vector3i::Zero();
  std::array<std::vector<float>, 3> values;  ///< [axis normal to the slice] values, the lower axis fastest
  bool labels = false;                       ///< whether values are organ numbers from 1; otherwise grey

  bool empty() const { return values[2].empty(); }
};

/// Returns the centre of the bounding box of all labels, in the frame of the map [voxels].
Vector3d middleOf(const LabelVolume& map);
ScanSlices slicesOf(const LabelVolume& map);

/// Keeps the three slices through a voxel while others read a source.
class SlicedSource : public SliceSource {
 public:
  /// @param at  voxel of the source
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

/// Returns the slices through a point of another scan; empty if the point is outside. Reads the scan once.
ScanSlices slicesAt(SliceSource& source, const Vector3d& position_m);

/// Writes front.png, left.png and above.png, which show the surfaces from three sides, and slice_axial.png,
/// slice_coronal.png and slice_sagittal.png. The slices show the scan, the contours of organs in the same colours, and
/// in blue the outer borders of their lattice cells.
/// @param organs  surfaces in the frame of the scan
/// @param scene   scene of these organs, moved likewise
/// @param notes   receives what is left out: the lattice of an organ that cannot have one
void writePreviews(const std::string& folder, const std::vector<const TriangleMesh*>& organs, const Scene& scene,
                   const ScanSlices& slices, std::vector<std::string>& notes);

}  // namespace viscera::cli
