// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "model/scan/byte_stream.h"
#include "model/scan/scan_source.h"

namespace viscera {

enum class VoxelType { kUint8, kInt8, kUint16, kInt16, kUint32, kInt32, kUint64, kInt64, kFloat, kDouble };
size_t bytesOf(VoxelType type);

/// Position and format of the voxels of one volume in a stream of bytes.
struct VoxelLayout {
  VolumeFrame frame;
  VoxelType type = VoxelType::kUint8;
  bool big_endian = false;
  double slope = 1, intercept = 0;
  uint64_t volumes = 1, volume = 0;        ///< volumes in sequence, and the one to read
  uint64_t components = 1, component = 0;  ///< components of each voxel, and the one to read
  std::vector<Segment> segments;
};

/// Returns the slices of one volume of a stream that is positioned at the first byte of the first volume.
/// @throws SceneError  the stream cannot hold the volumes in addition to the `before` bytes that were already read
std::unique_ptr<ScanSource> slicesOf(std::unique_ptr<ByteStream> stream, VoxelLayout layout, uint64_t before);

/// Checks the numbers of voxels. @throws SceneError  names the file
void requireSize(const std::string& path, const std::array<int64_t, 3>& size);
/// Returns whether voxels may have this distance: 1e-3 .. 100 mm.
bool isSpacing(double spacing_mm);
/// Checks a spacing. @throws SceneError  names the file, the steps and the accepted range, 1e-3 .. 100 mm
void requireSpacing(const std::string& path, const char* key, double spacing_mm);
/// Returns the index of the volume to read. @param asked  -1: not chosen   @throws SceneError  there are several, or
/// fewer
uint64_t chosenVolume(const std::string& path, int asked, uint64_t volumes, const ScanOptions& options);
/// Notes what a listing guesses. @returns whether it may guess
bool isGuessed(const std::string& path, const ScanOptions& options, const std::string& what);

/// Returns the frame with x_ros = (-y, x, z) of LPS / 1000. @throws SceneError  not finite, steps out of range, or
/// coplanar axes
VolumeFrame frameFromLps(const std::string& path, const std::array<int64_t, 3>& size, const Eigen::Matrix3d& axes_mm,
                         const Vector3d& origin_mm);
/// Returns rows that rotate axes, named by their directions ("RAS"), into LPS. @throws SceneError  not three such
/// letters
Eigen::Matrix3d lpsFromAxes(const std::string& path, const std::string& axes);

}  // namespace viscera
