// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>

#include "session/arrows.h"
#include "session/on_backends.h"
#include "support/backends.h"

namespace viscera {
namespace {

using namespace test;

class OverlayPictures : public OnSceneBackend {
 protected:
  static Scene scene() {
    Scene scene = OnSceneBackend::scene();
    scene.cameras[0].width_px = 160;
    scene.cameras[0].height_px = 120;
    scene.styluses[0].button1 = ToolMode::kGrab;
    return scene;
  }
};

size_t pixelsThatDiffer(const ImageFrame& a, const ImageFrame& b) {
  size_t count = 0;
  for (size_t i = 0; i < a.rgb.size(); i += 3)
    count += !std::equal(a.rgb.begin() + static_cast<long>(i), a.rgb.begin() + static_cast<long>(i) + 3,
                         b.rgb.begin() + static_cast<long>(i));
  return count;
}

/// Returns the largest excess of green over blue on the tissue: the scale of strains goes from blue to yellow.
int yellowest(const ImageFrame& image) {
  int most = -255;
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width * 3 / 4; ++column) {
      const uint8_t* const pixel = &image.rgb[3 * static_cast<size_t>(row * image.width + column)];
      most = std::max(most, pixel[1] - pixel[2]);
    }
  }
  return most;
}

TEST_P(OverlayPictures, EachIsSeenAndGoesAgain) {
  Session session(scene(), context_);
  play(session, press, kPressTicks);
  session.drain();
  const ImageFrame plain = picture(session);
  for (const OverlayName& overlay : kOverlayNames) {
    if (overlay.value == Overlay::kWind) continue;  // there is none
    session.setOverlays(0, overlaysOf({overlay.name}));
    const ImageFrame with = picture(session);
    EXPECT_GT(pixelsThatDiffer(plain, with), 20U) << overlay.name;
    session.setOverlays(0, {});
    EXPECT_EQ(pixelsThatDiffer(plain, picture(session)), 0U) << overlay.name;
  }
}

TEST_P(OverlayPictures, StrainIsBlueAtRestAndYellowWhereTheProbePresses) {
  Scene strained = scene();
  strained.cameras[0].overlays = overlaysOf({"strain"});
  strained.cameras[0].strain_range = 0.02;
  Session session(strained, context_);
  const int at_rest = yellowest(picture(session));
  for (int t = 1; t <= kPressTicks; ++t) session.step(press(t), {});
  session.step({}, {});    // no tool in the image
  EXPECT_LT(at_rest, 10);  // the background, which is grey
  EXPECT_GT(yellowest(picture(session)), 60);
}

TEST_P(OverlayPictures, TissueStepsAsWithoutThem) {
  Scene plain = scene(), over = scene();
  over.cameras[0].overlays = overlaysOf({"lattice", "springs", "normals", "strain", "forces"});
  FrameRequest outputs;
  outputs.cameras = {true};
  const auto hashOf = [&](const Scene& scene) {
    Session session(scene, context_);
    play(session, press, kPressTicks, outputs);
    return session.stateHash();
  };
  EXPECT_EQ(hashOf(plain), hashOf(over));
}

VISCERA_ON_EVERY_BACKEND(OverlayPictures);

TEST(Arrows, ForcesStandAtTipsAndWindComesFromAhead) {
  ToolMotions motions{};
  std::array<Reaction, layout::kMaxStyluses> reactions{};
  motions[1].present = true;
  motions[1].to.position_m = {0.1, 0.2, 0.3};
  reactions[0].force_n = {1, 0, 0};  // of an absent stylus
  reactions[1].force_n = {0, 0, 2};
  std::vector<Arrow> arrows;
  addForceArrows(motions, reactions, arrows);
  ASSERT_EQ(arrows.size(), 1U);
  EXPECT_TRUE(arrows[0] == (Arrow{Arrow::Kind::kForce, {0.1, 0.2, 0.3}, {0, 0, 2 * kArrowPerNewton_m}}));

  Model model;
  model.bodies.resize(1);
  model.bodies[0].skin.mesh.positions_m = {{0, 0, 0}, {0.1F, 0.1F, 0.1F}};
  arrows.clear();
  addWindArrows(Vector3d(0, 5, 0), model, arrows);
  ASSERT_EQ(arrows.size(), 9U);
  for (const Arrow& arrow : arrows) {
    EXPECT_LT((arrow.along_m - Vector3d(0, 5 * kArrowOfWind_s, 0)).norm(), 1e-12);
    EXPECT_LT((arrow.from_m + arrow.along_m).y(), 0);
  }
  arrows.clear();
  addWindArrows(Vector3d::Zero(), model, arrows);
  EXPECT_TRUE(arrows.empty());
}

}  // namespace
}  // namespace viscera
