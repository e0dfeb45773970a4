// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Solid objects in front of tissue hide it, with either method of lighting (docs/benchmarks.md, Picture).
#include <cstdlib>

#include "model/scene/tool_kinds.h"
#include "render/drawing.h"
#include "render/tube_painter.h"
#include "viscera/model/model.h"

using namespace viscera;

namespace {

constexpr int kHiddenLevels = 1;  ///< of 255, largest effect of objects behind: rounding of a mean
constexpr int kSameLevels = 2;    ///< of 255, between two supersamplings: rounding of samples and of their mean

/// A red wall that fills the picture, with the objects of a test in front of it.
class SolidOverTissueGl : public Drawing {
 protected:
  SolidOverTissueGl() {
    model_.bodies.emplace_back();
    ObstacleConfig ball;
    ball.shape = ObstacleShape::kSphere;
    ball.radius_m = 0.01;
    obstacles_ = {ball};
  }
  /// @param place  (renderer) adds sutures and obstacles
  template <class Position>
  Image drawn(int supersampling, bool with_wall, const ToolMotions& motions, Position position) {
    camera_.supersampling = supersampling;
    const GpuMesh wall = squareMesh(0.3f, {0, -1, 0});
    const gpu::Buffer<layout::vec4> rests(
        std::vector<layout::vec4>{{-0.3f, 0, -0.3f, 0}, {0.3f, 0, -0.3f, 0}, {0.3f, 0, 0.3f, 0}, {-0.3f, 0, 0.3f, 0}});
    MeshView view = wall.view();
    view.rests = rests.id();
    Renderer renderer({camera_}, styluses_, obstacles_, &model_);
    position(renderer);
    return draw(renderer, with_wall ? view : MeshView(), motions);
  }

  /// Compares the pixels that solid objects cover completely: those which do not depend on the wall behind.
  template <class Position>
  void expectNothingShinesThrough(const ToolMotions& motions, Position position) {
    constexpr int kFewest = 100;  // pixels
    const Image clean = drawn(2, true, motions, position), alone = drawn(2, false, motions, position);
    const Image quick = drawn(0, true, motions, position);
    int covered = 0, worst = 0;
    for (size_t pixel = 0; pixel < clean.rgb.size(); pixel += 3) {
      if (furthest(clean, alone, pixel) > kHiddenLevels) continue;
      ++covered;
      worst = std::max(worst, furthest(quick, clean, pixel));
    }
    EXPECT_GT(covered, kFewest);
    EXPECT_LE(worst, kSameLevels);
  }

  Model model_;
  std::vector<ObstacleConfig> obstacles_;

 private:
  static int furthest(const Image& a, const Image& b, size_t pixel) {
    int most = 0;
    for (size_t i = pixel; i < pixel + 3; ++i) most = std::max(most, std::abs(a.rgb[i] - b.rgb[i]));
    return most;
  }
};

}  // namespace

TEST_F(SolidOverTissueGl, ToolsOfEveryModeHideTheTissueBehindThem) {
  for (const ToolKind& kind : kToolKinds) {
    SCOPED_TRACE(kind.name);
    ToolMotions motions;
    motions[0].present = true;
    motions[0].mode = kind.mode;
    motions[0].opens_to_rad = 0.4;
    motions[0].to = {Vector3d(0.01, -0.08, -0.02), rotationFromDegrees({20, 35, 70})};
    expectNothingShinesThrough(motions, [](Renderer&) {});
  }
}

TEST_F(SolidOverTissueGl, SuturesNeedlesClipsAndObstaclesHideTheTissueBehindThem) {
  VisibleTubes shown;
  std::vector<TubeStyle> styles;
  for (const TubeKind part : {TubeKind::kSuture, TubeKind::kNeedle, TubeKind::kClip}) {
    const double z_m = 0.02 * static_cast<double>(styles.size()) - 0.03;
    styles.push_back({0.003, {40, 60, 200, 255}, 3, 0, part});
    shown.push_back({0, part, {{-0.05, -0.05, z_m}, {0, -0.09, z_m + 0.01}, {0.05, -0.05, z_m}}});
  }
  expectNothingShinesThrough({}, [&](Renderer& renderer) {
    renderer.addTubes(styles);
    renderer.placeTubes(shown);
    renderer.placeObstacles({Pose{Vector3d(0, -0.06, 0.04), Quaterniond::Identity()}});
  });
}
