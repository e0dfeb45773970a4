// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "model/shape/detail/detail_paint.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "model/shape/organ/phantom.h"

namespace viscera::test {
namespace {

constexpr double kLength_m = 0.1, kSkin_m = 0.006;

TriangleMesh skinOf(const Phantom& heart) {
  return extractSkin(heart.field, heart.part_names, heart.min_m, heart.max_m, kSkin_m);
}

/// Returns vertices of a surface with their normals, as many as a row has.
PaintRow rowOf(const TriangleMesh& skin, const PlacedPaint& on, size_t first) {
  const std::vector<Vector3f> normals = vertexNormals(skin);
  PaintRow row;
  for (size_t l = 0; l < PaintRow::kMost && first + l < normals.size(); ++l, ++row.count) {
    const Vector3d position = on.turn * (skin.positions_m[first + l].cast<double>() / on.unit_m) + on.shift;
    const Vector3d normal = on.turn * normals[first + l].cast<double>();
    for (int i = 0; i < 3; ++i) {
      row.position[static_cast<size_t>(i)][l] = static_cast<float>(position[i]);
      row.normal[static_cast<size_t>(i)][l] = static_cast<float>(normal[i]);
    }
  }
  return row;
}

Vector3f positionOf(const PaintRow& row, size_t l) {
  return {row.position[0][l], row.position[1][l], row.position[2][l]};
}

TEST(DetailPaint, WhatIsLeftOutElsewhereWouldHaveChangedNothing) {
  const PlacedPaint on = heartPaint(kLength_m, 1);
  const TriangleMesh skin = skinOf(heartPhantom(kLength_m, 1));
  constexpr float kAll = 3;  // in lengths of the heart
  std::vector<uint32_t> all, near;
  on.paint->findNear(Vector3f::Zero(), kAll, all);
  size_t covered = 0, fewer = 0;
  for (size_t first = 0; first < skin.positions_m.size(); first += PaintRow::kMost) {
    PaintRow whole = rowOf(skin, on, first), part = whole;
    on.paint->paint(all, whole);
    Vector3f middle = Vector3f::Zero();
    for (size_t l = 0; l < part.count; ++l) middle += positionOf(part, l) / static_cast<float>(part.count);
    float radius = 0;
    for (size_t l = 0; l < part.count; ++l) radius = std::max(radius, (positionOf(part, l) - middle).norm());
    on.paint->findNear(middle, radius, near);
    fewer += near.size() < all.size() ? 1 : 0;
    on.paint->paint(near, part);
    for (size_t l = 0; l < part.count; ++l) {
      ASSERT_EQ(part.cover[l], whole.cover[l]);
      ASSERT_EQ(part.height[l], whole.height[l]);
      covered += part.cover[l] > 0 ? 1 : 0;
      for (size_t i = 0; i < 3 && part.cover[l] > 0; ++i) ASSERT_EQ(part.color[i][l], whole.color[i][l]);
    }
  }
  EXPECT_GT(covered, skin.positions_m.size() / 50);
  EXPECT_GT(fewer, 0u);
}

TEST(DetailPaint, IsTheSameEveryTimeAndTurnsWithTheBody) {
  const TriangleMesh skin = skinOf(heartPhantom(kLength_m, 1));
  const PlacedPaint on = heartPaint(kLength_m, 1);
  constexpr int kLargest_px = 1024;
  const TriangleMesh once = paintDetail(skin, on, kLargest_px), twice = paintDetail(skin, on, kLargest_px);
  for (size_t i = 0; i < 2; ++i) EXPECT_EQ(once.detail->images[i].rgba, twice.detail->images[i].rgba);
  const auto shareCovered = [](const TriangleMesh& mesh) {
    const std::vector<uint8_t>& color = mesh.detail->images[0].rgba;
    size_t covered = 0;
    for (size_t i = 3; i < color.size(); i += 4) covered += color[i] > 0 ? 1 : 0;
    return 4.0 * static_cast<double>(covered) / static_cast<double>(color.size());
  };
  const double covered = shareCovered(once);
  EXPECT_GT(covered, 0.05);
  EXPECT_LT(covered, 0.15);
  const Pose moved{{0.3, -0.1, 0.2}, rotationFromDegrees({20, 30, 40})};
  TriangleMesh away = skin;
  for (Vector3f& p : away.positions_m) p = (moved * p.cast<double>()).cast<float>();
  PlacedPaint there = on;
  const Pose back = moved.inverse();
  there.shift += there.turn * (back.position_m / there.unit_m);
  there.turn = there.turn * back.orientation;
  // The order of triangles in the atlas differs, and float32 rounds at 0.4 m: only the share is preserved.
  constexpr double kOrder = 0.02;
  EXPECT_NEAR(shareCovered(paintDetail(away, there, kLargest_px)), covered, kOrder * covered);
}

/// The progress callback throws, as at the end of a program: the painting threads end too.
TEST(DetailPaint, IsEndedByItsProgress) {
  const TriangleMesh skin = skinOf(heartPhantom(kLength_m, 1));
  const auto ends = [](const std::string&, double) { throw 1; };
  EXPECT_THROW(paintDetail(skin, heartPaint(kLength_m, 1), 1024, ends), int);
}

}  // namespace
}  // namespace viscera::test
