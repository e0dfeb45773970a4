// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Lines of marks on surface meshes, for viewers without the renderer.
#include "viscera/surface/skin_marks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "surface/marks/mark_board.h"
#include "surface/marks/mark_grid.h"
#include "viscera/model/scene/scene.h"

namespace viscera {
namespace {

constexpr double kHalf_m = 0.02, kWidth_m = 0.001;
constexpr float kRounding_m = 1e-6F;  // float32 at 2 cm, through barycentric weights

Model blockModel() {
  Scene scene;
  BodyConfig body;
  body.source = TissueSource::kBox;
  body.box_size_m = Vector3d::Constant(2 * kHalf_m);
  body.spacing_m = 0.005;
  scene.bodies = {body};
  return buildModel(scene);
}

MarkConfig topLine() {
  MarkConfig mark;
  mark.path = {{{-0.012, 0.003, kHalf_m + 0.004}}, {{0.012, 0.003, kHalf_m + 0.004}}};
  mark.normal = Vector3d::UnitZ();
  mark.width_m = kWidth_m;
  return mark;
}

/// Returns the uncut surface mesh, moved.
template <class Move>
VisibleMesh meshOf(const Model& model, Move move) {
  VisibleMesh mesh;
  auto topology = std::make_shared<VisibleTopology>();
  topology->revision = 1;
  const TriangleMesh& rest = model.bodies[0].skin.mesh;
  for (const Vector3f& at : rest.positions_m) {
    const Vector3f to = move(at);
    mesh.positions_m.insert(mesh.positions_m.end(), {to.x(), to.y(), to.z()});
    mesh.normals.push_back(packNormal(Vector3f::UnitZ()));
  }
  for (const auto& triangle : rest.triangles)
    topology->triangles.insert(topology->triangles.end(), triangle.begin(), triangle.end());
  topology->vertices = mesh.normals.size();
  mesh.topology = topology;
  return mesh;
}

Vector3f same(const Vector3f& at) {
  return at;
}

TEST(SkinMarks, ALineIsMovedAlongItsNormalOntoTheSurface) {
  const Model model = blockModel();
  MarkBoard board(model);
  const auto marks = board.show({topLine()});
  ASSERT_EQ(marks->strokes->size(), 1U);
  const MarkStroke& stroke = marks->strokes->front();
  for (const SkinPoint& point : stroke.points) {
    EXPECT_NEAR(point.rest_m.z(), kHalf_m, kRounding_m);
    EXPECT_NEAR(point.rest_m.y(), 0.003F, kRounding_m);
  }
  EXPECT_NEAR(stroke.points.front().rest_m.x(), -0.012F, kRounding_m);
  EXPECT_NEAR(stroke.points.back().along_m, 0.024F, kRounding_m);
}

TEST(SkinMarks, LinesFollowTheVertices) {
  const Model model = blockModel();
  MarkBoard board(model);
  const auto marks = board.show({topLine()});
  const auto stretch = [](const Vector3f& at) { return Vector3f(1.5F * at.x(), 0.8F * at.y(), at.z() + 0.01F); };
  const std::vector<MarkPiece> pieces = markPieces(*marks, meshOf(model, stretch));
  ASSERT_GT(pieces.size(), 5U);
  const float above_m = kHalf_m + 0.01F + kWidth_m / 2;
  float length_m = 0;
  for (const MarkPiece& piece : pieces) {
    EXPECT_NEAR(piece.from_m.z(), above_m, kRounding_m);
    EXPECT_NEAR(piece.from_m.y(), 0.8F * 0.003F, kRounding_m);
    EXPECT_FLOAT_EQ(piece.width_m, kWidth_m);
    length_m += (piece.to_m - piece.from_m).norm();
  }
  EXPECT_NEAR(length_m, 1.5F * 0.024F, 10 * kRounding_m);
}

TEST(SkinMarks, PatternsDifferInTheirLines) {
  const Model model = blockModel();
  const VisibleMesh mesh = meshOf(model, same);
  MarkBoard board(model);
  std::vector<float> areas;
  std::shared_ptr<const std::vector<MarkStroke>> strokes;
  for (const MarkPattern pattern :
       {MarkPattern::kSolid, MarkPattern::kDashed, MarkPattern::kDouble, MarkPattern::kCrossed, MarkPattern::kThin}) {
    MarkConfig mark = topLine();
    mark.pattern = pattern;
    const auto marks = board.show({mark});
    if (strokes) {
      EXPECT_EQ(marks->strokes, strokes) << "another pattern needs no other strokes";
    }
    strokes = marks->strokes;
    float area = 0;
    for (const MarkPiece& piece : markPieces(*marks, mesh)) area += (piece.to_m - piece.from_m).norm() * piece.width_m;
    areas.push_back(area / (0.024F * kWidth_m));
  }
  EXPECT_NEAR(areas[0], 1, 0.01);
  EXPECT_NEAR(areas[1], 0.583, 0.08) << "of the dashes' share, 7 of 12, to a part of half a width";
  EXPECT_NEAR(areas[2], 1.6, 0.02);
  // Crosses begin after 2.5 half widths and follow every 10. Each has two arms of 2 x 3.2 half widths along and across.
  constexpr double kHalves = 0.024 / (0.5 * kWidth_m);
  const double crosses = 1 + std::floor((kHalves - 2.5) / 10), arm = 2 * 3.2 * std::sqrt(2.0) * 1.6;
  EXPECT_NEAR(areas[3], 0.5 + crosses * 2 * arm / (2 * kHalves), 0.01);
  EXPECT_NEAR(areas[4], 0.5, 0.01);
}

TEST(SkinMarks, ARingIsTheSectionOfTheSurface) {
  const Model model = blockModel();
  MarkConfig ring;
  ring.kind = MarkKind::kRing;
  ring.center_m = Vector3d(0.0013, 0, 0);  // between the vertices
  ring.normal = Vector3d::UnitX();
  ring.radius_m = 2 * kHalf_m;
  MarkBoard board(model);
  const auto marks = board.show({ring});
  EXPECT_EQ(board.faultOf(0), "");
  float length_m = 0;
  for (const MarkPiece& piece : markPieces(*marks, meshOf(model, same))) length_m += (piece.to_m - piece.from_m).norm();
  EXPECT_NEAR(length_m, 8 * kHalf_m, 1e-4) << "around a square";
  ring.radius_m = 0.01;
  board.show({ring});
  EXPECT_NE(board.faultOf(0), "");
}

TEST(SkinMarks, PiecesOfSplitTrianglesStayWithTheirCornersAndNotAcrossTheGap) {
  const Model model = blockModel();
  MarkConfig across;
  across.path = {{{0.001, -0.012, kHalf_m}}, {{0.001, 0.012, kHalf_m}}};
  across.normal = Vector3d::UnitZ();
  MarkBoard board(model);
  const auto marks = board.show({across});
  constexpr float kGap_m = 0.01F, kPlane_m = 0.001F;
  const auto part = [&](const Vector3f& at) {
    return Vector3f(at + (at.y() > kPlane_m ? kGap_m : 0) * Vector3f::UnitY());
  };
  VisibleMesh mesh = meshOf(model, part);
  auto cut = std::make_shared<VisibleTopology>(*mesh.topology);
  cut->revision = 2;
  const TriangleMesh& rest = model.bodies[0].skin.mesh;
  for (size_t t = 0; t < rest.triangles.size(); ++t) {
    size_t beyond = 0;
    for (const uint32_t vertex : rest.triangles[t]) beyond += rest.positions_m[vertex].y() > kPlane_m;
    if (beyond % 3 != 0) std::fill_n(cut->triangles.begin() + static_cast<ptrdiff_t>(3 * t), 3, 0U);
  }
  mesh.topology = cut;
  size_t near = 0, far = 0;
  for (const MarkPiece& piece : markPieces(*marks, mesh)) {
    EXPECT_LT((piece.to_m - piece.from_m).norm(), kGap_m / 2);
    for (const Vector3f& end : {piece.from_m, piece.to_m}) {
      near += end.y() <= kPlane_m + 0.005F;
      far += end.y() > kPlane_m + 0.005F;
    }
  }
  EXPECT_GT(near, 4U);
  EXPECT_GT(far, 4U);
}

TEST(MarkGrid, EveryPointNearALineFindsItInItsCell) {
  const Model model = blockModel();
  MarkBoard board(model);
  MarkConfig circle = topLine();
  circle.kind = MarkKind::kCircle;
  circle.center_m = Vector3d(0, 0, kHalf_m);
  circle.radius_m = 0.012;
  const auto marks = board.show({topLine(), circle});
  const MarkGrid grid = gridOf(*marks->strokes);
  EXPECT_LT(grid.segments.size(), size_t{3} * 80) << "straight pieces are joined";
  size_t checked = 0;
  for (const MarkStroke& stroke : *marks->strokes) {
    for (const SkinPoint& point : stroke.points) {
      for (const float off_m : {-4 * stroke.half_width_m, 0.0F, 4 * stroke.half_width_m}) {
        const Vector3f at = point.rest_m + Vector3f(0, off_m, 0);
        const Vector3f cell = ((at - grid.corner_m) / grid.cell_m).array().floor();
        const auto index =
            static_cast<size_t>(cell.x()) +
            grid.counts[0] * (static_cast<size_t>(cell.y()) + size_t{grid.counts[1]} * static_cast<size_t>(cell.z()));
        const uint32_t first = grid.cells[index] >> 8, count = grid.cells[index] & 255U;
        float nearest_m = INFINITY;
        for (uint32_t i = first; i < first + count; ++i) {
          const layout::vec4 &a = grid.segments[3 * size_t{grid.cells[i]}],
                             &b = grid.segments[3 * size_t{grid.cells[i]} + 1];
          const Vector3f from(a.x, a.y, a.z), offset = Vector3f(b.x, b.y, b.z) - from;
          const float share = std::clamp((at - from).dot(offset) / offset.squaredNorm(), 0.0F, 1.0F);
          nearest_m = std::min(nearest_m, (at - from - share * offset).norm());
        }
        EXPECT_LE(nearest_m, std::abs(off_m) + stroke.half_width_m / 5);
        ++checked;
      }
    }
  }
  EXPECT_GT(checked, 60U);
}

}  // namespace
}  // namespace viscera
