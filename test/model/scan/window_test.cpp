// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scan/window.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "model/mesh_samples.h"
#include "model/scan/pieces.h"
#include "model/scan/scan_source.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

/// Scan with values given by a function of voxels.
class MadeScan : public SliceSource {
 public:
  MadeScan(const Vector3i& size, const Vector3d& spacing_m, std::function<float(int, int, int)> value)
      : value_(std::move(value)) {
    frame_.size = size;
    frame_.axes = spacing_m.asDiagonal();
    frame_.origin = Vector3d(1, 2, 3);
  }
  const VolumeFrame& frame() const override { return frame_; }
  const std::vector<LabelName>& names() const override { return names_; }
  void next(std::vector<float>& values) override {
    values.clear();
    for (int j = 0; j < frame_.size.y(); ++j)
      for (int i = 0; i < frame_.size.x(); ++i) values.push_back(value_(i, j, slice_));
    ++slice_;
  }

 private:
  VolumeFrame frame_;
  std::vector<LabelName> names_;
  std::function<float(int, int, int)> value_;
  int slice_ = 0;
};

size_t voxels(const LabelVolume& v) {
  return static_cast<size_t>(std::count(v.labels.begin(), v.labels.end(), 1));
}

bool within(int i, int j, int k, int low, int high) {
  return std::min({i, j, k}) >= low && std::max({i, j, k}) < high;
}

/// Returns two cubes of 4 and 3 voxels, and one voxel that touches the first by an edge.
float cubes(int i, int j, int k) {
  return within(i, j, k, 2, 6) ? 100.F : within(i, j, k, 9, 12) ? 120.F : i == 6 && j == 6 && k == 3 ? 100.F : 0.F;
}

TEST(Window, KeepsTheLargestPieces) {
  const Vector3d spacing(.001, .002, .003);
  const auto run = [&](WindowOptions options, WindowReport& report) {
    MadeScan scan({14, 15, 16}, spacing, cubes);
    options.low = 50;
    options.high = 200;
    return windowed(scan, options, &report);
  };
  WindowReport report;
  const LabelVolume one = run({}, report);
  EXPECT_EQ(voxels(one), 64U);
  EXPECT_EQ(report.in_window, 64U + 27 + 1);
  EXPECT_EQ(report.pieces, 3U);
  EXPECT_NEAR(report.kept_cm3, 64 * 6e-3, 1e-9);
  EXPECT_EQ(one.frame.size, Vector3i(8, 8, 8));  // cropped, with two voxels around
  EXPECT_EQ(report.first, Vector3i(0, 0, 0));
  EXPECT_LT((one.frame.origin - Vector3d(1, 2, 3)).norm(), 1e-12);
  WindowOptions all;
  all.pieces = 0;
  WindowReport of_all;
  EXPECT_EQ(voxels(run(all, of_all)), 92U);
  all.least_cm3 = 0.1;
  WindowReport of_large;
  EXPECT_EQ(voxels(run(all, of_large)), 91U);
  all.least_cm3 = 10;
  EXPECT_THROW(run(all, of_large), SceneError);
}

TEST(Window, WhatIsCutAtTheBorderIsSaidAndClosedThere) {
  MadeScan scan({6, 6, 6}, {.001, .001, .001}, [](int, int, int) { return 1.F; });
  WindowOptions options;
  options.low = options.high = 1;
  options.closing_mm = 3;
  WindowReport report;
  const LabelVolume full = windowed(scan, options, &report);
  EXPECT_EQ(voxels(full), 216U);  // the empty border exists before closing, so nothing grows along it
  EXPECT_EQ(report.at_border, 216U - 64);
  EXPECT_EQ(full.frame.size, Vector3i(10, 10, 10));
  EXPECT_EQ(report.first, Vector3i(-2, -2, -2));
}

TEST(Window, ClosingClosesGapsAndHolesOnRequestOnly) {
  // A cube of 12 voxels with a slit of one voxel and a hole of four.
  const auto value = [](int i, int j, int k) {
    return within(i, j, k, 4, 16) && i != 6 && !within(i, j, k, 10, 14) ? 10.F : 0.F;
  };
  const auto run = [&](double closing, bool fill, WindowReport& report) {
    MadeScan scan({20, 20, 20}, {.001, .001, .001}, value);
    WindowOptions options;
    options.low = options.high = 10;
    options.closing_mm = closing;
    options.fill_holes = fill;
    return voxels(windowed(scan, options, &report));
  };
  WindowReport report;
  EXPECT_EQ(run(0, false, report), 144U * 9 - 64);
  // A ball of one voxel reaches from outside into the slit's rim, and covers all of the hole except edges and corners.
  EXPECT_EQ(run(1, false, report), 1728U - 44 - 32);
  EXPECT_EQ(run(1, true, report), 1728U - 44);
  EXPECT_NEAR(report.filled_cm3, 32e-3, 1e-12);
}

TEST(Window, ValuesThatAreNoNumbersAreOutsideOfAll) {
  const auto value = [](int i, int, int) { return i == 1 ? std::numeric_limits<float>::quiet_NaN() : float(i); };
  MadeScan scan({4, 3, 3}, {.001, .001, .001}, value);
  WindowOptions options;
  options.low = -1e9;
  options.high = 1e9;
  options.pieces = 0;
  WindowReport report;
  EXPECT_EQ(voxels(windowed(scan, options, &report)), 27U);
  EXPECT_EQ(report.not_numbers, 9U);
  EXPECT_EQ(report.largest, 3);
}

TEST(Window, OutsideOfTheRangeItIsRefusedWithIt) {
  MadeScan scan({4, 3, 3}, {.001, .001, .001}, [](int i, int, int) { return float(i); });
  WindowOptions options;
  options.low = 180;
  options.high = 600;
  try {
    windowed(scan, options);
    FAIL();
  } catch (const SceneError& error) {
    EXPECT_NE(std::string(error.what()).find("0 .. 3"), std::string::npos) << error.what();
  }
  options.low = 700;
  EXPECT_THROW(windowed(scan, options), SceneError);
  options = {};
  options.closing_mm = 50;
  EXPECT_THROW(windowed(scan, options), SceneError);
}

/// Compares with a flood fill and distances by definition, on noise.
TEST(Window, PiecesAndDistancesAreThoseOfTheirDefinition) {
  std::mt19937 random(7);
  for (int round = 0; round < 20; ++round) {
    Mask mask;
    mask.size = Vector3i(9, 8, 7);
    mask.voxels.resize(9 * 8 * 7);
    for (uint8_t& v : mask.voxels) v = random() % 100 < 20 + 3 * static_cast<unsigned>(round);
    std::vector<uint64_t> expected;
    Mask left = mask;
    std::function<uint64_t(int, int, int)> flood = [&](int i, int j, int k) -> uint64_t {
      const Vector3i at(i, j, k);
      if ((at.array() < 0).any() || (at.array() >= mask.size.array()).any() || !left.voxels[left.at(i, j, k)]) return 0;
      left.voxels[left.at(i, j, k)] = 0;
      return 1 + flood(i - 1, j, k) + flood(i + 1, j, k) + flood(i, j - 1, k) + flood(i, j + 1, k) +
             flood(i, j, k - 1) + flood(i, j, k + 1);
    };
    for (int k = 0; k < 7; ++k)
      for (int j = 0; j < 8; ++j)
        for (int i = 0; i < 9; ++i)
          if (const uint64_t n = flood(i, j, k)) expected.push_back(n);
    const Pieces pieces(mask, 1);
    std::vector<uint64_t> found;
    for (const uint64_t n : pieces.voxels())
      if (n > 0) found.push_back(n);
    std::sort(found.begin(), found.end());
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(found, expected);
    Mask without = mask;
    const auto largest = static_cast<uint32_t>(std::max_element(pieces.voxels().begin(), pieces.voxels().end()) -
                                               pieces.voxels().begin());
    pieces.assign(
        without, [&](uint32_t piece) { return piece != largest; }, 0);
    EXPECT_EQ(static_cast<uint64_t>(std::count(without.voxels.begin(), without.voxels.end(), 1)), found.back());
    EXPECT_EQ(Pieces(without, 1).count(), 1U);
    Mask grown = mask;
    const Vector3d spacing(1, 1.5, 2.5);
    grow(grown, 1, spacing, 2.5);
    for (int k = 0; k < 7; ++k)
      for (int j = 0; j < 8; ++j)
        for (int i = 0; i < 9; ++i) {
          bool near = false;
          for (int c = 0; c < 7; ++c)
            for (int b = 0; b < 8; ++b)
              for (int a = 0; a < 9; ++a)
                near |=
                    mask.voxels[mask.at(a, b, c)] && Vector3d(a - i, b - j, c - k).cwiseProduct(spacing).norm() <= 2.5;
          EXPECT_EQ(grown.voxels[grown.at(i, j, k)] != 0, near) << round << ' ' << i << ' ' << j << ' ' << k;
        }
  }
}

TEST(Window, TheRealScan) {
  const std::string path = test::realData("ct/example_ct_sm.nii.gz");
  if (path.empty()) GTEST_SKIP() << "ct/ not found; set VISCERA_TEST_DATA";
  WindowOptions options;
  options.low = -200;  // skin
  options.high = 3000;
  options.closing_mm = 3;
  options.fill_holes = true;
  WindowReport report;
  const auto scan = openScan(path);
  const LabelVolume body = windowed(*scan, options, &report);
  EXPECT_GT(report.at_border, 1000U);  // a torso is cut above and below
  EXPECT_LT(report.least, -900);
  EXPECT_GT(voxels(body), 50000U);
}

}  // namespace
}  // namespace viscera
