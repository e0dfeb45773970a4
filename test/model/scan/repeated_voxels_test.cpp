// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scan/repeated_voxels.h"

#include <gtest/gtest.h>

namespace viscera {
namespace {

constexpr int kSide = 20;

/// Returns a ball of two labels, below and above the middle of k.
LabelVolume ball() {
  LabelVolume map;
  map.frame.size = Vector3i::Constant(kSide);
  map.frame.axes *= 0.002;
  map.frame.origin = Vector3d(0.01, 0.02, 0.03);
  for (int k = 0; k < kSide; ++k)
    for (int j = 0; j < kSide; ++j)
      for (int i = 0; i < kSide; ++i) {
        const double r = (Vector3d(i, j, k) - Vector3d::Constant(9.3)).norm();
        map.labels.push_back(static_cast<uint8_t>(r > 8 ? 0 : k < 9 ? 1 : 2));
      }
  map.names = {{0, ""}, {1, "lower"}, {2, "upper"}};
  return map;
}

/// Returns the map with every voxel repeated along each axis, without the first `cut` voxels of the result.
LabelVolume repeated(const LabelVolume& map, const Vector3i& times, const Vector3i& cut) {
  LabelVolume out = map;
  out.labels.clear();
  out.frame.size = map.frame.size.cwiseProduct(times) - cut;
  for (int axis = 0; axis < 3; ++axis) {
    out.frame.axes.col(axis) /= times[axis];
    out.frame.origin += out.frame.axes.col(axis) * (cut[axis] - 0.5 * (times[axis] - 1));
  }
  for (int k = 0; k < out.frame.size.z(); ++k)
    for (int j = 0; j < out.frame.size.y(); ++j)
      for (int i = 0; i < out.frame.size.x(); ++i) {
        const Vector3i from = (Vector3i(i, j, k) + cut).cwiseQuotient(times);
        out.labels.push_back(map.labels[static_cast<size_t>(from.x() + kSide * (from.y() + kSide * from.z()))]);
      }
  return out;
}

TEST(RepeatedVoxels, AreFoundAndTakenOut) {
  const LabelVolume map = ball();
  for (const Repeats& r : repeatsOf(map)) EXPECT_EQ(r.times, 1);
  const Vector3i times(2, 1, 3);
  for (const Vector3i& cut : {Vector3i(0, 0, 0), Vector3i(1, 0, 2)}) {
    const LabelVolume fine = repeated(map, times, cut);
    const std::array<Repeats, 3> repeats = repeatsOf(fine);
    for (int axis = 0; axis < 3; ++axis) EXPECT_EQ(repeats[static_cast<size_t>(axis)].times, times[axis]) << axis;
    const LabelVolume coarse = withoutRepeats(fine, repeats);
    EXPECT_EQ(coarse.frame.size, map.frame.size);
    EXPECT_EQ(coarse.labels, map.labels);
    EXPECT_LT((coarse.frame.axes - map.frame.axes).norm(), 1e-12);
    EXPECT_LT((coarse.frame.origin - map.frame.origin).norm(), 1e-12);
  }
}

TEST(RepeatedVoxels, ABoxSaysNothing) {
  LabelVolume map = ball();
  for (size_t n = 0; n < map.labels.size(); ++n) {
    const int i = static_cast<int>(n) % kSide, j = static_cast<int>(n) / kSide % kSide;
    map.labels[n] = i >= 4 && i < 16 && j >= 4 && j < 16;
  }
  for (const Repeats& r : repeatsOf(map)) EXPECT_EQ(r.times, 1);
}

}  // namespace
}  // namespace viscera
