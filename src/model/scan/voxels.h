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

/// Where the voxels of one volume are in a stream of bytes, and what they are.
struct VoxelLayout {
  VolumeFrame frame;
  VoxelType type = VoxelType::kUint8;
  bool big_endian = false;
  double slope = 1, intercept = 0;
  uint64_t volumes = 1, volume = 0;        ///< one after the other, and the one that is read
  uint64_t components = 1, component = 0;  ///< side by side in each voxel, and the one that is read
  std::vector<Segment> segments;
};

/// The slices of one volume of a stream that stands at the first byte of the first.
/// @throws SceneError  the stream cannot hold the volumes, beside `before` bytes that were read of it already
std::unique_ptr<ScanSource> slicesOf(std::unique_ptr<ByteStream> stream, VoxelLayout layout, uint64_t before);

/// The accepted numbers of voxels. @throws SceneError  naming the file
void requireSize(const std::string& path, const std::array<int64_t, 3>& size);
/// Whether voxels may be so far apart: 1e-3 .. 100 mm.
bool isSpacing(double spacing_mm);
/// @throws SceneError  naming the file, the steps and what is accepted, 1e-3 .. 100 mm
void requireSpacing(const std::string& path, const char* key, double spacing_mm);
/// The one that is asked for of several. @param asked  -1: not told   @throws SceneError  they are several, or fewer
uint64_t chosenVolume(const std::string& path, int asked, uint64_t volumes, const ScanOptions& options);
/// Notes what a listing guesses. @returns whether it may
bool isGuessed(const std::string& path, const ScanOptions& options, const std::string& what);

/// x_ros = (-y, x, z) of LPS / 1000. @throws SceneError  not finite, steps out of range, or all in one plane
VolumeFrame frameFromLps(const std::string& path, const std::array<int64_t, 3>& size, const Eigen::Matrix3d& axes_mm,
                         const Vector3d& origin_mm);
/// Rows that turn axes, named by where they lead to ("RAS"), into LPS. @throws SceneError  not three such letters
Eigen::Matrix3d lpsFromAxes(const std::string& path, const std::string& axes);

}  // namespace viscera
