// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "render/drawing.h"
#include "viscera/model/scene/stylus_config.h"

using namespace viscera;

namespace {

constexpr ToolMode kToolsModes[] = {ToolMode::kNone,         ToolMode::kProbe,   ToolMode::kGrab,   ToolMode::kCut,
                                    ToolMode::kCutParticles, ToolMode::kSuction, ToolMode::kNeedle, ToolMode::kScissors,
                                    ToolMode::kGrasper,      ToolMode::kClip,    ToolMode::kCautery};

class ToolsGl : public Drawing {
 protected:
  /// Returns the motions of a stylus with its tip at a point [m], its shaft up (+z), and the flat of its blade towards
  /// the camera.
  static ToolMotions tool(ToolMode mode, const Vector3d& tip_m = Vector3d::Zero()) {
    ToolMotions motions;
    motions[0].present = true;
    motions[0].mode = mode;
    motions[0].to = {tip_m, Quaterniond(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitZ()))};
    return motions;
  }
  double pixelsPerMetre() const { return intrinsics(camera_).fy / 0.3; }
  const MeshView nothing_;
};

int differingPixels(const Image& a, const Image& b) {
  int count = 0;
  for (size_t i = 0; i < a.rgb.size(); i += 3) count += std::equal(&a.rgb[i], &a.rgb[i] + 3, &b.rgb[i]) ? 0 : 1;
  return count;
}

/// Returns the first and the last row with drawn pixels [px].
std::pair<int, int> drawnRows(const Image& image) {
  std::pair<int, int> rows{image.height, -1};
  for (int row = 0; row < image.height; ++row) {
    for (int column = 1; column < image.width; ++column) {
      if (image.drawn(column, row)) rows = {std::min(rows.first, row), std::max(rows.second, row)};
    }
  }
  return rows;
}

}  // namespace

TEST_F(ToolsGl, AbsentStylusIsNotDrawnWhateverItsMode) {
  for (ToolMode mode : kToolsModes) {
    ToolMotions motions = tool(mode);
    motions[0].present = false;
    EXPECT_EQ(draw(nothing_, motions).drawnPixels(), 0);
  }
}

TEST_F(ToolsGl, PresentStylusWithoutAModeIsAShaft) {
  const Image image = draw(nothing_, tool(ToolMode::kNone));
  EXPECT_GT(image.drawnPixels(), 200);
  EXPECT_LE(drawnRows(image).second, image.height / 2 + 1) << "nothing hangs below the tip";
  EXPECT_EQ(drawnRows(image).first, 0) << "12 cm of shaft leave the image at its top";
}

TEST_F(ToolsGl, EveryModeIsDrawnDifferently) {
  std::vector<Image> images;
  for (ToolMode mode : kToolsModes) images.push_back(draw(nothing_, tool(mode)));
  for (size_t a = 0; a < images.size(); ++a) {
    for (size_t b = a + 1; b < images.size(); ++b) {
      EXPECT_GT(differingPixels(images[a], images[b]), 50) << "modes " << a << " and " << b;
    }
  }
}

TEST_F(ToolsGl, ActingPartsAreDrawnInTheirTrueSize) {
  constexpr double kWithin_px = 2;
  styluses_[0].probe.radius_m = 0.01;
  styluses_[0].grab.radius_m = 0.015;
  styluses_[0].cut.blade_length_m = 0.03;
  styluses_[0].cut.blade_side = BladeSide::kAhead;
  styluses_[0].cut_particles.eraser_radius_m = 0.005;
  const double middle = camera_.height_px / 2.0;
  auto reach_px = [&](ToolMode mode) { return drawnRows(draw(nothing_, tool(mode))).second + 1 - middle; };
  EXPECT_NEAR(reach_px(ToolMode::kProbe), 0.010 * pixelsPerMetre(), kWithin_px);
  EXPECT_NEAR(reach_px(ToolMode::kGrab), 0.015 * pixelsPerMetre(), kWithin_px);
  EXPECT_NEAR(reach_px(ToolMode::kCut), 0.030 * pixelsPerMetre(), kWithin_px);
  EXPECT_NEAR(reach_px(ToolMode::kCutParticles), 0.035 * pixelsPerMetre(), kWithin_px);
}

TEST_F(ToolsGl, FingersStandAsFarOpenAsTheMotionSays) {
  constexpr double kLength_m = 0.03, kOpening_rad = 0.8;
  constexpr int kTip_px = 3;  // above the tips, which are pointed
  styluses_[0].grasper.jaw_length_m = kLength_m;
  styluses_[0].grasper.radius_m = 1e-4;  // so small that the sphere of the reach hides nothing
  ToolMotions motions = tool(ToolMode::kGrasper);
  motions[0].to.orientation = Quaterniond::Identity();  // the jaws open in the image plane
  const auto drawnAt = [&](double opening_rad, double half_rad) {
    motions[0].opens_to_rad = opening_rad;
    const Image image = draw(nothing_, motions);
    const double x_px = kLength_m * std::sin(half_rad) * pixelsPerMetre();
    const double z_px = kLength_m * (1 - std::cos(half_rad)) * pixelsPerMetre();
    return image.drawn(image.width / 2 + static_cast<int>(std::lround(x_px)),
                       image.height / 2 - static_cast<int>(std::lround(z_px)) - kTip_px);
  };
  EXPECT_TRUE(drawnAt(0, 0));
  EXPECT_FALSE(drawnAt(0, 0.5 * kOpening_rad));
  for (const double side : {-0.5, 0.5}) EXPECT_TRUE(drawnAt(kOpening_rad, side * kOpening_rad)) << side;
  EXPECT_FALSE(drawnAt(kOpening_rad, 0));
}

TEST_F(ToolsGl, TissueHidesWhatIsBehindItAndShinesThroughAGrabOutline) {
  const GpuMesh square = squareMesh(0.1f, {0, -1, 0});
  const Image tissue = draw(square.view());
  const Image behind = draw(square.view(), tool(ToolMode::kProbe, {0, 0.05, -0.02}));
  EXPECT_EQ(behind.sum(160, 130), tissue.sum(160, 130));
  const Image before = draw(square.view(), tool(ToolMode::kProbe, {0, -0.05, -0.02}));
  EXPECT_GT(before.at(160, 138)[2], before.at(160, 138)[0]) << "the probe is blue before red tissue";
  const Image outline = draw(square.view(), tool(ToolMode::kGrab, {0, -0.05, 0.0}));
  EXPECT_GT(outline.at(160, 122)[0], 2 * outline.at(160, 122)[1]) << "red shines through";
}

TEST_F(ToolsGl, OutlineOfOneStylusDoesNotHideThatOfTheOther) {
  constexpr int kSumWithin = 3;  // levels over three channels: rounding depends on the order of blending
  const ToolMotions near = tool(ToolMode::kGrab, {0, -0.05, 0}), far = tool(ToolMode::kGrab, {0.008, 0, 0});
  const Image near_first = draw(nothing_, {near[0], far[0]}), far_first = draw(nothing_, {far[0], near[0]});
  const int column = camera_.width_px / 2 + 9, row = camera_.height_px / 2 + 5;  // in both outlines, off both jaws
  EXPECT_GT(near_first.sum(column, row), draw(nothing_, near).sum(column, row));
  EXPECT_NEAR(near_first.sum(column, row), far_first.sum(column, row), kSumWithin);
}

TEST_F(ToolsGl, ToolShadesTheTissueBelowIt) {
  const GpuMesh square = squareMesh(0.1f, {0, -1, 0});
  const Image tissue = draw(square.view()), shaded = draw(square.view(), tool(ToolMode::kNone, {-0.03, -0.02, -0.03}));
  int darker = 0;
  for (int row = 0; row < tissue.height; ++row) {
    for (int column = 0; column < tissue.width; ++column) {
      const bool red = shaded.at(column, row)[0] > 2 * shaded.at(column, row)[2];
      darker += red && shaded.sum(column, row) < 0.8 * tissue.sum(column, row) ? 1 : 0;
    }
  }
  EXPECT_GT(darker, 100);
}

TEST_F(ToolsGl, BothStylusesAreDrawnAtTheirPoses) {
  ToolMotions motions = tool(ToolMode::kProbe, {-0.04, 0, -0.02});
  motions[1] = motions[0];
  motions[1].to.position_m.x() = 0.04;
  const Image image = draw(nothing_, motions);
  const int shift_px = static_cast<int>(std::lround(0.04 * pixelsPerMetre()));
  const int row = image.height / 2 + static_cast<int>(std::lround(0.02 * pixelsPerMetre()));
  EXPECT_TRUE(image.drawn(image.width / 2 - shift_px, row));
  EXPECT_TRUE(image.drawn(image.width / 2 + shift_px, row));
  EXPECT_FALSE(image.drawn(image.width / 2, row));
}
