// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "surface/skins/part_colors.h"

#include <gtest/gtest.h>

#include "model/skin_shapes.h"

using namespace viscera;
using namespace viscera::testing;

namespace {

const Vector3d kOrgan(0.72, 0.25, 0.22);

}  // namespace

TEST(PartColors, FirstPartHasTheColorOfTheOrgan) {
  EXPECT_TRUE(partColor(kOrgan, 0).isApprox(kOrgan, 1e-12));
}

TEST(PartColors, PartsOfAnOrganDifferVisiblyButStayNearIt) {
  constexpr double kVisible = 2.5 / 255;  // [-] more than two steps of an 8-bit channel
  constexpr double kNear = 0.3;           // [-] of every channel
  for (size_t a = 0; a < 14; ++a) {
    EXPECT_LT(((partColor(kOrgan, a) - kOrgan).cwiseQuotient(kOrgan)).cwiseAbs().maxCoeff(), kNear);
    for (size_t b = a + 1; b < 14; ++b) {
      EXPECT_GT((partColor(kOrgan, a) - partColor(kOrgan, b)).cwiseAbs().maxCoeff(), kVisible) << a << ", " << b;
    }
  }
}

TEST(PartColors, WhiteStaysWithinTheChannels) {
  for (size_t part = 0; part < 50; ++part) {
    EXPECT_LE(partColor(Vector3d::Ones(), part).maxCoeff(), 1.0);
    EXPECT_GE(partColor(Vector3d::Zero(), part).minCoeff(), 0.0);
  }
}

TEST(PartColors, VertexHasTheColorOfItsLowestPartInRgbaOrder) {
  TriangleMesh mesh = sheetMesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1);  // two triangles that share vertices 0 and 3
  mesh.parts = {1, 0};
  const std::vector<uint32_t> colors = vertexColors(mesh, Vector3d(1, 0.5, 0));
  ASSERT_EQ(colors.size(), 4u);
  EXPECT_EQ(colors[0], 0xff0080ffu);
  EXPECT_EQ(colors[0], colors[3]);
  EXPECT_EQ(colors[0], colors[2]);
  EXPECT_NE(colors[0], colors[1]);
}

TEST(PartColors, AlphaTellsSheetsFromSolids) {
  const TriangleMesh mesh = sheetMesh({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1);
  EXPECT_EQ(vertexColors(mesh, Vector3d(1, 0.5, 0), false)[0], 0xff0080ffu);
  EXPECT_EQ(vertexColors(mesh, Vector3d(1, 0.5, 0), true)[0], 0x000080ffu);
}
