// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/scan/surface_net.h"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <random>
#include <set>

#include "model/scan/net_phantoms.h"
#include "viscera/math/error.h"

namespace viscera::test {
namespace {

const Vector3d kThickSlices(0.7, 0.7, 1.5);  ///< [mm]
const Vector3d kThickerSlices(1, 1, 3);      ///< [mm]

double voxelMm(const Vector3d& spacing_mm) {
  return std::cbrt(spacing_mm.prod());
}

SurfaceNet netOf(const NetPhantom& phantom, const Vector3d& spacing_mm) {
  return surfaceNet(sampled(phantom, frameAround(phantom, spacing_mm, turned())));
}

/// Measured errors of each shape (docs/volumes.md), rounded up in their last digit.
struct Most {
  double rms, volume_percent, normals_deg;
};

/// Limit for the farthest point of any of them; half a voxel diagonal of the thicker slices.
constexpr double kMostApart = 0.8;

void expectLike(const NetPhantom& phantom, const Vector3d& spacing_mm, const Most& most) {
  const SurfaceNet net = netOf(phantom, spacing_mm);
  const NetScore found = score(net, 1, phantom, voxelMm(spacing_mm));
  EXPECT_LE(found.rms, most.rms);
  EXPECT_LE(found.largest, kMostApart);
  EXPECT_LE(std::abs(found.volume_percent), most.volume_percent);
  EXPECT_LE(found.normals_deg, most.normals_deg);
  const NetTopology shape = topology(labelSurfaces(net, {}, {1}));
  EXPECT_EQ(shape.euler, phantom.euler);
  EXPECT_EQ(shape.open, 0u);
  EXPECT_EQ(shape.touching, net.touching_edges);
}

TEST(SurfaceNet, Ball) {
  expectLike(ballPhantom(), kThickSlices, {.115, .25, 7.5});
  expectLike(ballPhantom(), kThickerSlices, {.165, .85, 10.5});
}

TEST(SurfaceNet, TubeOfTwoVoxels) {
  expectLike(tubePhantom(2 * voxelMm(kThickSlices)), kThickSlices, {.115, .15, 9.5});
  expectLike(tubePhantom(2 * voxelMm(kThickerSlices)), kThickerSlices, {.125, .55, 11.5});
}

TEST(SurfaceNet, PlateOfOneVoxelAndAHalf) {
  expectLike(platePhantom(1.5 * voxelMm(kThickSlices)), kThickSlices, {.125, .55, 11.5});
  expectLike(platePhantom(1.5 * voxelMm(kThickerSlices)), kThickerSlices, {.165, .25, 16.5});
}

TEST(SurfaceNet, Vessel) {
  expectLike(vesselPhantom(), kThickSlices, {.115, .1, 8.5});
  expectLike(vesselPhantom(), kThickerSlices, {.165, .45, 14.5});
}

TEST(SurfaceNet, TouchingBallsHaveTheSameBorder) {
  for (const Vector3d& spacing_mm : {kThickSlices, kThickerSlices}) {
    const LabelVolume volume = sampled(touchingBalls(1), frameAround(touchingBalls(1), spacing_mm, turned()));
    const SurfaceNet net = surfaceNet(volume);
    const TriangleMesh both = labelSurfaces(net, volume.names, {1, 2});
    EXPECT_EQ(both.part_names, (std::vector<std::string>{"one", "two"}));
    std::multiset<std::array<uint32_t, 3>> sides[2];  // triangles of the border, from the lowest vertex on
    size_t shared = 0;
    for (size_t i = 0; i < net.sides.size(); ++i) shared += net.sides[i][0] + net.sides[i][1] == 3;
    for (size_t i = 0; i < both.triangles.size(); ++i) {
      std::array<uint32_t, 3> t = both.triangles[i];
      if (both.parts[i] == 1) std::swap(t[1], t[2]);
      std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
      sides[both.parts[i]].insert(t);
    }
    std::vector<std::array<uint32_t, 3>> in_both;
    std::set_intersection(sides[0].begin(), sides[0].end(), sides[1].begin(), sides[1].end(),
                          std::back_inserter(in_both));
    EXPECT_GT(shared, 50u);
    EXPECT_EQ(in_both.size(), shared);
    for (const int label : {1, 2}) {
      const NetTopology shape = topology(labelSurfaces(net, volume.names, {static_cast<uint8_t>(label)}));
      EXPECT_EQ(shape.euler, 2);
      EXPECT_EQ(shape.open, 0u);
      // The disc where they touch has an edge, which the net rounds by half a voxel: more than for a ball.
      const NetScore found = score(net, label, touchingBalls(label), voxelMm(spacing_mm));
      EXPECT_LE(found.rms, 0.2);
      EXPECT_LE(std::abs(found.volume_percent), 0.25);
    }
    // The outside is the complement of both.
    EXPECT_NEAR(-net.volumeM3(0), net.volumeM3(1) + net.volumeM3(2), 1e-12 * net.volumeM3(1));
  }
}

TEST(SurfaceNet, ShearedAndMirroredFrames) {
  const NetPhantom ball = ballPhantom();
  Matrix3d tilted = turned();  // slices of a gantry tilted by 14 degrees: the third axis is inclined towards the second
  tilted.col(2) = (tilted.col(2) + std::tan(14 * M_PI / 180) * tilted.col(1)).normalized();
  const double voxel_mm = std::cbrt(std::abs((tilted * kThickSlices.asDiagonal()).determinant()));
  const SurfaceNet sheared = surfaceNet(sampled(ball, frameAround(ball, kThickSlices, tilted)));
  const NetScore found = score(sheared, 1, ball, voxel_mm);
  EXPECT_LE(found.rms, 0.125);  // a sheared box extends a little farther than a straight one
  EXPECT_LE(std::abs(found.volume_percent), 0.25);
  EXPECT_LE(found.normals_deg, 7.5);

  Matrix3d mirrored = turned();
  mirrored.col(0) *= -1;
  const SurfaceNet net = surfaceNet(sampled(ball, frameAround(ball, kThickSlices, mirrored)));
  const NetScore seen = score(net, 1, ball, voxelMm(kThickSlices));
  EXPECT_LE(seen.rms, 0.115);
  EXPECT_LE(std::abs(seen.volume_percent), 0.25);  // positive volume: triangles face outward
  EXPECT_LE(seen.normals_deg, 7.5);
}

/// Returns the same labels at the same positions, stored along other axes. @param order  original axis of each new axis
LabelVolume stored(const LabelVolume& from, const std::array<int, 3>& order, int flips) {
  LabelVolume to = from;
  for (int a = 0; a < 3; ++a) {
    const bool flipped = flips >> a & 1;
    to.frame.size[a] = from.frame.size[order[a]];
    to.frame.axes.col(a) = (flipped ? -1 : 1) * from.frame.axes.col(order[a]);
    if (flipped) to.frame.origin += (to.frame.size[a] - 1) * from.frame.axes.col(order[a]);
  }
  size_t at = 0;
  Vector3i v;
  for (v[2] = 0; v[2] < to.frame.size.z(); ++v[2]) {
    for (v[1] = 0; v[1] < to.frame.size.y(); ++v[1]) {
      for (v[0] = 0; v[0] < to.frame.size.x(); ++v[0]) {
        Vector3i w;
        for (int a = 0; a < 3; ++a) w[order[a]] = flips >> a & 1 ? to.frame.size[a] - 1 - v[a] : v[a];
        to.labels[at++] = from.labels[w.x() + static_cast<size_t>(from.frame.size.x()) *
                                                  (w.y() + static_cast<size_t>(from.frame.size.y()) * w.z())];
      }
    }
  }
  return to;
}

/// @param labels  number of labels
void expectOneVolumeInAllOrders(const LabelVolume& volume, int labels) {
  constexpr double kRounding = 1e-12;  // sums of doubles in different orders
  const SurfaceNet truth = surfaceNet(volume);
  std::array<int, 3> order = {0, 1, 2};
  do {
    for (int flips = 0; flips < 8; ++flips) {
      const SurfaceNet net = surfaceNet(stored(volume, order, flips));
      EXPECT_EQ(net.triangles.size(), truth.triangles.size());
      EXPECT_EQ(net.touching_edges, truth.touching_edges);
      for (int label = 1; label <= labels; ++label) {
        const double expected = truth.volumeM3(label);
        EXPECT_NEAR(net.volumeM3(label), expected, kRounding * expected)
            << "label " << label << ", axes " << order[0] << order[1] << order[2] << ", flips " << flips;
      }
    }
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(SurfaceNet, AllOrdersOfAxesGiveOneVolume) {
  const NetPhantom balls = touchingBalls(1);
  expectOneVolumeInAllOrders(sampled(balls, frameAround(balls, {2, 2, 3}, turned())), 2);
  // Along the axes, where diagonals of quads are equal.
  expectOneVolumeInAllOrders(sampled(balls, frameAround(balls, {2, 2, 2}, Matrix3d::Identity())), 2);
}

LabelVolume noise(const Vector3i& size, int labels, unsigned seed) {
  LabelVolume volume;
  volume.frame.size = size;
  volume.frame.axes = 1e-3 * Matrix3d::Identity();
  volume.labels.resize(volume.frame.voxels());
  std::mt19937 random(seed);
  for (uint8_t& label : volume.labels) label = random() % (labels + 1);
  return volume;
}

TEST(SurfaceNet, NoiseGivesClosedSurfacesInAllOrders) {
  const LabelVolume volume = noise({5, 6, 7}, 3, 4);
  expectOneVolumeInAllOrders(volume, 3);
  const SurfaceNet net = surfaceNet(volume);
  size_t touching = 0;
  for (const uint8_t label : {1, 2, 3}) {
    const NetTopology shape = topology(labelSurfaces(net, {}, {label}));
    EXPECT_EQ(shape.open, 0u);
    touching += shape.touching;
  }
  EXPECT_GT(net.touching_edges, 0u);
  EXPECT_GE(touching, net.touching_edges);  // two labels may touch along one edge
}

TEST(SurfaceNet, VoxelsThatTouchAlongAnEdgeAreJoinedAndCounted) {
  LabelVolume volume = noise({4, 4, 3}, 0, 1);
  volume.labels[1 + 4 * (1 + 4 * 1)] = volume.labels[2 + 4 * (2 + 4 * 1)] = 1;
  const SurfaceNet net = surfaceNet(volume);
  EXPECT_EQ(net.touching_edges, 1u);
  EXPECT_EQ(topology(labelSurfaces(net, {}, {1})).touching, 1u);
  EXPECT_EQ(topology(labelSurfaces(net, {}, {1})).open, 0u);
}

TEST(SurfaceNet, LabelsAtTheBorderAreClosedThere) {
  LabelVolume volume = noise({6, 5, 4}, 0, 1);
  std::fill(volume.labels.begin(), volume.labels.end(), 1);
  const SurfaceNet net = surfaceNet(volume);
  const NetTopology shape = topology(labelSurfaces(net, {}, {1}));
  EXPECT_EQ(shape.euler, 2);
  EXPECT_EQ(shape.open, 0u);
  constexpr double kOfCuts = 0.005;  // volumes are kept half way between the two divisions of quads
  EXPECT_NEAR(net.volumeM3(1), 6 * 5 * 4 * 1e-9, kOfCuts * 6 * 5 * 4 * 1e-9);
}

TEST(SurfaceNet, ThreeLabelsMeetInALine) {
  LabelVolume volume = noise({16, 16, 12}, 0, 1);
  for (int k = 2; k < 10; ++k) {
    for (int j = 2; j < 14; ++j) {
      for (int i = 2; i < 14; ++i) volume.labels[i + 16 * (j + 16 * k)] = j < 8 ? 1 : i < 8 ? 2 : 3;
    }
  }
  const SurfaceNet net = surfaceNet(volume);
  const double voxels[4] = {0, 12 * 6 * 8, 6 * 6 * 8, 6 * 6 * 8};
  for (const uint8_t label : {1, 2, 3}) {
    const NetTopology shape = topology(labelSurfaces(net, {}, {label}));
    EXPECT_EQ(shape.euler, 2);
    EXPECT_EQ(shape.open, 0u);
    EXPECT_EQ(shape.touching, 0u);
    EXPECT_NEAR(net.volumeM3(label) * 1e9, voxels[label], 0.01 * voxels[label]);
  }
}

TEST(SurfaceNet, LeftStaysLeft) {
  LabelVolume volume = noise({12, 12, 12}, 0, 1);
  volume.frame.axes.col(0) << 0, -1e-3, 0;  // first voxel at the left, as in right-to-left files
  volume.frame.axes.col(1) << 1e-3, 0, 0;
  volume.frame.axes.col(2) << 0, 0, 1e-3;
  volume.frame.origin << 0, 0.0055, 0;
  for (int k = 3; k < 6; ++k) {
    for (int j = 3; j < 6; ++j) {
      for (int i = 1; i < 4; ++i) volume.labels[i + 12 * (j + 12 * k)] = 1;
    }
  }
  std::array<int, 3> order = {0, 1, 2};
  do {
    for (int flips = 0; flips < 8; ++flips) {
      const SurfaceNet net = surfaceNet(stored(volume, order, flips));
      EXPECT_GT(net.volumeM3(1), 0);
      Eigen::AlignedBox3d box;
      for (const Vector3d& p : net.positions_m) box.extend(p);
      const Vector3d middle = box.center();
      EXPECT_NEAR(middle.x(), 0.004, 1e-6);
      EXPECT_NEAR(middle.y(), 0.0035, 1e-6);  // left is +y
      EXPECT_NEAR(middle.z(), 0.004, 1e-6);
    }
  } while (std::next_permutation(order.begin(), order.end()));
}

/// Simulates a scan of a phantom: partial volumes, blurred by half a voxel in each direction, with noise of 5 % of the
/// step.
std::vector<float> scanned(const NetPhantom& phantom, const VolumeFrame& frame) {
  constexpr int kFine = 4;  // samples along each axis of a voxel near the surface
  std::vector<float> values(frame.voxels());
  const double far_mm = 2000 * frame.spacing_m().maxCoeff();
  forEachVoxel(frame, [&](size_t at, const Vector3d& p) {
    const double d = phantom.distance(p);
    if (std::abs(d) > far_mm) {
      values[at] = d < 0;
      return;
    }
    int inside = 0;
    for (int q = 0; q < kFine * kFine * kFine; ++q) {
      const Vector3d step(q % kFine, q / kFine % kFine, q / kFine / kFine);
      const Vector3d from_middle = (step.array() + 0.5) / kFine - 0.5;
      inside += phantom.distance(p + 1000 * frame.axes * from_middle) < 0;
    }
    values[at] = static_cast<float>(inside) / (kFine * kFine * kFine);
  });
  const double weight[3] = {std::erf(M_SQRT1_2), 0.5 * (std::erf(3 * M_SQRT1_2) - std::erf(M_SQRT1_2)),
                            0.5 * (1 - std::erf(3 * M_SQRT1_2))};  // of a Gaussian over voxels
  size_t stride = 1;
  for (int a = 0; a < 3; ++a) {
    const std::vector<float> sharp = values;
    const int size = frame.size[a];
    for (size_t c = 0; c < sharp.size(); ++c) {
      const int i = static_cast<int>(c / stride % size);
      double sum = weight[0] * sharp[c];
      for (int q = 1; q < 3; ++q) {
        sum += weight[q] *
               (sharp[c + stride * (std::min(size - 1, i + q) - i)] + sharp[c - stride * (i - std::max(0, i - q))]);
      }
      values[c] = static_cast<float>(sum);
    }
    stride *= size;
  }
  std::mt19937 random(7);
  std::normal_distribution<float> noise(0, 0.05f);
  for (float& v : values) v += noise(random);
  return values;
}

void expectLikeByValues(const NetPhantom& phantom, const Vector3d& spacing_mm, const Most& most) {
  LabelVolume volume = sampled(phantom, frameAround(phantom, spacing_mm, turned()));
  const std::vector<float> values = scanned(phantom, volume.frame);
  for (size_t i = 0; i < values.size(); ++i) volume.labels[i] = values[i] >= 0.5f;
  const ValueWindow window{0.5f, 10, [&](size_t voxel) { return values[voxel]; }};
  const SurfaceNet net = surfaceNet(volume, &window);
  const NetScore found = score(net, 1, phantom, voxelMm(spacing_mm));
  EXPECT_LE(found.rms, most.rms);
  EXPECT_LE(std::abs(found.volume_percent), most.volume_percent);
  EXPECT_LE(found.normals_deg, most.normals_deg);
  const NetTopology shape = topology(labelSurfaces(net, {}, {1}));
  EXPECT_EQ(shape.euler, phantom.euler);
  EXPECT_EQ(shape.open, 0u);
}

TEST(SurfaceNet, ValuesPlaceABall) {
  expectLikeByValues(ballPhantom(), kThickSlices, {.055, .55, 3.5});
  expectLikeByValues(ballPhantom(), kThickerSlices, {.09, .55, 5.5});
}

TEST(SurfaceNet, ValuesOfThinWallsLoseWhatBlurTakes) {
  expectLikeByValues(tubePhantom(2 * voxelMm(kThickSlices)), kThickSlices, {.145, 3.6, 11.5});
  expectLikeByValues(tubePhantom(2 * voxelMm(kThickerSlices)), kThickerSlices, {.195, 6.2, 15});
}

TEST(SurfaceNet, ValuesPlaceBothSidesOfAWindow) {
  LabelVolume volume = noise({40, 24, 24}, 0, 1);
  const auto value = [&](size_t voxel) { return static_cast<float>(voxel % 40); };  // a ramp along x
  const ValueWindow window{9.3f, 30.2f, value};
  for (size_t i = 0; i < volume.labels.size(); ++i) volume.labels[i] = value(i) >= 9.3f && value(i) <= 30.2f;
  const SurfaceNet net = surfaceNet(volume, &window);
  // In the middle of the slab's faces; the rims are rounded. The volume of whole voxels is kept, 21 instead of 20.9
  // layers, which moves each face by about 0.05.
  constexpr double kOfVolume = 0.06;  // [voxels]
  for (const Vector3d& p : net.positions_m) {
    const Vector3d voxel = 1000 * p;
    if (std::abs(voxel.y() - 11.5) > 4 || std::abs(voxel.z() - 11.5) > 4) continue;
    EXPECT_NEAR(voxel.x(), voxel.x() < 20 ? 9.3 : 30.2, kOfVolume);
  }
}

TEST(SurfaceNet, UnknownValuesAreHalfway) {
  const LabelVolume volume = sampled(ballPhantom(), frameAround(ballPhantom(), {2, 2, 2}, turned()));
  const ValueWindow window{0, 1, [](size_t) { return std::numeric_limits<float>::quiet_NaN(); }};
  const SurfaceNet net = surfaceNet(volume, &window);
  for (const Vector3d& p : net.positions_m) EXPECT_TRUE(p.allFinite());
  EXPECT_LE(score(net, 1, ballPhantom(), 2).largest, kMostApart);
}

TEST(SurfaceNet, NothingGivesNothing) {
  const SurfaceNet net = surfaceNet(noise({3, 4, 5}, 0, 1));
  EXPECT_TRUE(net.triangles.empty());
  EXPECT_TRUE(labelSurfaces(net, {}, {1}).triangles.empty());
  EXPECT_EQ(net.volumeM3(1), 0);
}

TEST(SurfaceNet, RefusesWhatIsNoVolume) {
  LabelVolume volume = noise({3, 4, 5}, 1, 1);
  volume.labels.pop_back();
  EXPECT_THROW(surfaceNet(volume), SceneError);
  volume = noise({3, 4, 5}, 1, 1);
  volume.frame.axes.col(2) = volume.frame.axes.col(1);
  EXPECT_THROW(surfaceNet(volume), SceneError);
  volume.frame.axes.col(2).setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_THROW(surfaceNet(volume), SceneError);
  volume = noise({3, 4, 5}, 1, 1);
  volume.frame.origin.x() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(surfaceNet(volume), SceneError);
}

}  // namespace
}  // namespace viscera::test
