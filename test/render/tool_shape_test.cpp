// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "render/shapes/tool_shape.h"
#include "viscera/model/scene/stylus_config.h"

#include <gtest/gtest.h>

using namespace viscera;

namespace {

constexpr ToolMode kModes[] = {ToolMode::kNone,         ToolMode::kProbe,   ToolMode::kGrab,   ToolMode::kCut,
                               ToolMode::kCutParticles, ToolMode::kSuction, ToolMode::kNeedle, ToolMode::kScissors,
                               ToolMode::kGrasper,      ToolMode::kClip,    ToolMode::kCautery};
constexpr float kTight_m = 1e-6f;  // rounding of float coordinates of some centimetres

Vector3f position(const ToolVertex& vertex) {
  return Vector3f(vertex.position_m.data());
}
Vector3f normal(const ToolVertex& vertex) {
  return Vector3f(vertex.normal.data());
}

float lowestZ(const ToolShape& shape) {
  float lowest = 1;
  for (const ToolVertex& vertex : shape.vertices) lowest = std::min(lowest, vertex.position_m[2]);
  return lowest;
}

}  // namespace

TEST(ToolShape, TrianglesFaceOutwards) {
  constexpr float kSmallestArea = 1e-14f;  // [m2] triangles at poles are degenerate and have no side
  for (ToolMode mode : kModes) {
    const ToolShape shape = toolShape(StylusConfig(), mode);
    for (size_t i = 0; i < shape.indices.size(); i += 3) {
      const ToolVertex &a = shape.vertices[shape.indices[i]], &b = shape.vertices[shape.indices[i + 1]],
                       &c = shape.vertices[shape.indices[i + 2]];
      const Vector3f side = (position(b) - position(a)).cross(position(c) - position(a));
      if (side.norm() < kSmallestArea) continue;
      ASSERT_GT(side.dot(normal(a) + normal(b) + normal(c)), 0) << "triangle " << i / 3;
    }
  }
}

TEST(ToolShape, NormalsAreUnit) {
  for (ToolMode mode : kModes) {
    for (const ToolVertex& vertex : toolShape(StylusConfig(), mode).vertices) {
      ASSERT_NEAR(normal(vertex).norm(), 1, 1e-5);
    }
  }
}

TEST(ToolShape, ActingPartsHaveTheSizesOfTheStylus) {
  StylusConfig stylus;
  stylus.probe.radius_m = 0.011;
  stylus.grab.radius_m = 0.016;
  stylus.cut.blade_length_m = 0.031;
  stylus.cut.blade_side = BladeSide::kAhead;
  stylus.cut_particles.eraser_radius_m = 0.004;
  stylus.suction.radius_m = 0.005;
  EXPECT_NEAR(lowestZ(toolShape(stylus, ToolMode::kNone)), 0, kTight_m);
  EXPECT_NEAR(lowestZ(toolShape(stylus, ToolMode::kProbe)), -0.011, kTight_m);
  EXPECT_NEAR(lowestZ(toolShape(stylus, ToolMode::kGrab)), -0.016, kTight_m);
  EXPECT_NEAR(lowestZ(toolShape(stylus, ToolMode::kCut)), -0.031, kTight_m);
  EXPECT_NEAR(lowestZ(toolShape(stylus, ToolMode::kCutParticles)), -0.035, kTight_m);
  EXPECT_NEAR(lowestZ(toolShape(stylus, ToolMode::kSuction)), -0.005, kTight_m);
  stylus.cut.blade_side = BladeSide::kBoth;
  EXPECT_NEAR(lowestZ(toolShape(stylus, ToolMode::kCut)), -0.031, kTight_m);
  stylus.cut.blade_side = BladeSide::kShaft;
  EXPECT_NEAR(lowestZ(toolShape(stylus, ToolMode::kCut)), 0, kTight_m);
  EXPECT_NEAR(lowestZ(toolShape(stylus, ToolMode::kCutParticles)), -0.004, kTight_m);
}

TEST(ToolShape, NoShaftIsWhereABladeCutsHoweverLongItIs) {
  constexpr float kFlat_m = 0.0005f;  // half the thickness of a blade of 2 cm, and less than the radius of the shaft
  StylusConfig stylus;
  const ToolShape shape = toolShape(stylus, ToolMode::kCut);
  for (const ToolVertex& vertex : shape.vertices) {
    if (vertex.position_m[2] > 0.001f && vertex.position_m[2] < 0.019f) {
      EXPECT_LT(std::abs(vertex.position_m[0]), kFlat_m);
    }
  }
  stylus.cut.blade_length_m = 0.5;
  float highest = 0;
  for (const ToolVertex& vertex : toolShape(stylus, ToolMode::kCut).vertices)
    highest = std::max(highest, vertex.position_m[2]);
  EXPECT_NEAR(highest, 0.55, 1e-3);  // the blade and its base
}

TEST(ToolShape, ShaftEndsTwelveCentimetresBehindTheTip) {
  for (ToolMode mode : kModes) {
    float highest = 0;
    for (const ToolVertex& vertex : toolShape(StylusConfig(), mode).vertices) {
      highest = std::max(highest, vertex.position_m[2]);
    }
    EXPECT_NEAR(highest, 0.12, kTight_m);
  }
}

TEST(ToolShape, ShaftsAreAsLongAsTheirKeySaysAndTheirThicknessFollows) {
  StylusConfig small;
  small.shaft_length_m = 0.03;
  EXPECT_NEAR(shaftRadius(StylusConfig()), 0.003, 1e-9);
  EXPECT_NEAR(shaftRadius(small), 0.00075, 1e-9);
  const ToolShape shape = toolShape(small, ToolMode::kNone), usual = toolShape(StylusConfig(), ToolMode::kNone);
  ASSERT_EQ(shape.vertices.size(), usual.vertices.size());
  for (size_t v = 0; v < shape.vertices.size(); ++v)
    EXPECT_LT((position(shape.vertices[v]) - position(usual.vertices[v]) / 4).norm(), kTight_m);
  EXPECT_NEAR(lowestZ(toolShape(small, ToolMode::kProbe)), -0.006, kTight_m);  // the acting part keeps its true size
}

TEST(ToolShape, OnlyTheSphereOfWhatHoldsIsTranslucent) {
  for (ToolMode mode : kModes) {
    const ToolShape shape = toolShape(StylusConfig(), mode);
    EXPECT_EQ(shape.solid_indices < shape.indices.size(),
              mode == ToolMode::kGrab || mode == ToolMode::kSuction || mode == ToolMode::kGrasper);
    for (size_t i = 0; i < shape.indices.size(); ++i) {
      EXPECT_EQ(shape.vertices[shape.indices[i]].color[3] == 255, i < shape.solid_indices);
    }
  }
}
