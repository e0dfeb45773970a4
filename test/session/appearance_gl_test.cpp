// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Optional looks of images (docs/surface.md, Looks), by the keys of a scene: the effect of each, and that it does not
// affect anything that does not request it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "math/srgb.h"
#include "session/on_backends.h"
#include "viscera/layout/picture_labels.h"

namespace viscera {
namespace {

using namespace test;

class Appearance : public OnSceneBackend {
 protected:
  /// Returns a block that fills much of an image.
  static Scene scene(int supersampling = 0) {
    Scene scene = OnSceneBackend::scene();
    scene.bodies[0].spacing_m = 0.005;  // shades are compared to a step of 255
    CameraConfig& camera = scene.cameras[0];
    camera.position_m = Vector3d(0, -0.07, 0.08);
    camera.width_px = 160;
    camera.height_px = 120;
    camera.supersampling = supersampling;
    return scene;
  }
  ImageFrame after(const Scene& scene, const StrokesByTick& strokes = {}, int ticks = 0,
                   PictureKind kind = PictureKind::kColor) {
    Session session(scene, context_);
    if (ticks > 0) play(session, strokes, ticks);
    session.drain();
    return picture(session, kind);
  }
};
VISCERA_ON_EVERY_BACKEND(Appearance);

constexpr int kOpenTicks = kCutTicks + 10;
/// Returns a cut, after which the far lip is drawn away by the other stylus.
StylusSamples opened(int tick) {
  if (tick <= kCutTicks) return cut(tick);
  StylusSamples samples;
  samples[1] = {true, {Vector3d(0, 0.008 + 0.001 * (tick - kCutTicks), kHalfM), Quaterniond::Identity()}, false, false};
  return samples;
}

/// Returns the light of one colour of a pixel, linear.
double light(const ImageFrame& image, int column, int row, size_t color) {
  return linearFromSrgb(image.rgb[3 * static_cast<size_t>(row * image.width + column) + color] / 255.0);
}

/// Returns the pixels in which some colour differs.
std::vector<size_t> changed(const ImageFrame& a, const ImageFrame& b) {
  std::vector<size_t> out;
  for (size_t i = 0; 3 * i < a.rgb.size(); ++i) {
    if (!std::equal(&a.rgb[3 * i], &a.rgb[3 * i] + 3, &b.rgb[3 * i])) out.push_back(i);
  }
  return out;
}

bool isWall(uint8_t label) {
  return label >= layout::kFirstWallLabel && label < layout::kFirstToolLabel;
}

double sumOf(const ImageFrame& image, size_t pixel) {
  return image.rgb[3 * pixel] + image.rgb[3 * pixel + 1] + image.rgb[3 * pixel + 2];
}

}  // namespace

/// Next to a body and a camera that request all of them. If nothing requests them, they are compiled out of the
/// shaders.
TEST_P(Appearance, ScenesWithoutThemAreDrawnAsBefore) {
  constexpr int kRounded = 1;  // of 255: other shaders round differently
  for (const int supersampling : {0, 2}) {
    const Scene plain = scene(supersampling);
    Scene beside = plain;
    BodyConfig far = plain.bodies[0];
    far.name = "far";
    far.position_m = Vector3d(1, 0, 0);  // outside the view of the first camera
    far.specular_wetness = far.cut_wall_texture = far.blanching = 1;
    beside.bodies.push_back(far);
    CameraConfig other = plain.cameras[0];
    other.name = "other";
    other.light = CameraLight::kLens;
    other.contact_shadows = 1;
    other.distortion.k1 = -0.3;
    beside.cameras.push_back(other);
    const auto bytes = [&](const Scene& of, bool all) {
      Session session(of, context_);
      play(session, press, kPressTicks);
      session.drain();
      FrameRequest outputs;
      outputs.cameras = {all, all};
      if (all) session.show(outputs);
      return picture(session).rgb;
    };
    const std::vector<uint8_t> alone = bytes(plain, false), with = bytes(beside, true);
    ASSERT_EQ(alone.size(), with.size());
    int most = 0;
    for (size_t i = 0; i < alone.size(); ++i) most = std::max(most, std::abs(alone[i] - with[i]));
    EXPECT_LE(most, kRounded) << "supersampling " << supersampling;
  }
}

TEST_P(Appearance, LightAtTheLensFadesWithTheSquareOfTheDistanceAndTowardsTheRimOfItsCone) {
  constexpr double kShare = 0.06;  // of the compared light: 8 bits of dark colours, and a light 4 mm from the lens
  Scene lit = scene();
  CameraConfig& camera = lit.cameras[0];
  lit.bodies[0].roughness = 1;
  lit.bodies[0].color_variation = 0;  // a uniform face
  lit.styluses.clear();
  camera.position_m = Vector3d(0, -0.12, 0);
  camera.vertical_fov_deg = 17;  // the front face, y = -kHalfM, fills the view
  camera.light = CameraLight::kLens;
  camera.light_cone_deg = 170;
  const auto at = [&](double focus_m, double cone_deg) {
    camera.target_m = camera.position_m + Vector3d(0, focus_m, 0);
    camera.light_cone_deg = cone_deg;
    return after(lit);
  };
  const double face_m = 0.1;
  const ImageFrame there = at(face_m, 170), halfway = at(face_m / 2, 170), narrow = at(face_m, 20);
  const int column = 80, row = 60;
  EXPECT_NEAR(light(halfway, column, row, 0) / light(there, column, row, 0), 0.25, 0.25 * kShare);
  EXPECT_NEAR(light(narrow, column, row, 0) / light(there, column, row, 0), 1, 0.1) << "4 mm aside of 18 mm";
  // In the lower left corner, 13 mm to the side and 10 + 4 mm below the light; half a cone of 10 degrees is 17.6.
  const double tangent = std::tan(8.5 * M_PI / 180), half = std::tan(10 * M_PI / 180);
  const Eigen::Vector2d aside(-tangent * 160 / 120 * face_m - 0.0015, tangent * face_m + 0.004);
  const double faded = std::exp2(-aside.squaredNorm() / (half * half * face_m * face_m));
  EXPECT_NEAR(light(narrow, 0, 119, 0) / light(there, 0, 119, 0), faded, 0.1 * faded);
  Scene lamp = lit;
  lamp.cameras[0].light = CameraLight::kLamp;
  lamp.cameras[0].target_m = camera.position_m + Vector3d(0, face_m, 0);
  const double as_lamp = light(there, column, row, 0) / light(after(lamp), column, row, 0);
  EXPECT_GT(as_lamp, 0.6) << "where it is set for";
  EXPECT_LT(as_lamp, 2.2) << "it comes from straight before the face, the lamp from aside";
}

TEST_P(Appearance, ContactShadowsAreWhereAToolIsNear) {
  Scene plain = scene(), dark = plain;
  dark.cameras[0].contact_shadows = 1;
  const auto above = [](double gap_m) {
    return [gap_m](int) { return leftAt({0, 0, kHalfM + kProbeRadiusM + gap_m}); };
  };
  const ImageFrame near = after(plain, above(0.001), 1), near_dark = after(dark, above(0.001), 1);
  const std::vector<size_t> pixels = changed(near, near_dark);
  EXPECT_GT(pixels.size(), 300U);
  for (const size_t i : pixels) EXPECT_LT(sumOf(near_dark, i), sumOf(near, i));
  double most = 0;
  for (const size_t i : pixels) most = std::max(most, sumOf(near, i) - sumOf(near_dark, i));
  EXPECT_GT(most, 60);
  const ImageFrame far = after(plain, above(0.05), 1), far_dark = after(dark, above(0.05), 1);
  double most_far = 0;
  for (const size_t i : changed(far, far_dark)) most_far = std::max(most_far, sumOf(far, i) - sumOf(far_dark, i));
  EXPECT_LT(most_far, 0.3 * most);
}

TEST_P(Appearance, LobulesAndBundlesAreOnWallsOfWoundsAlone) {
  for (const int supersampling : {0, 2}) {
    Scene plain = scene(supersampling);
    plain.cameras[0].position_m = Vector3d(0.01, -0.02, 0.1);
    plain.cameras[0].vertical_fov_deg = 25;
    plain.styluses[1].idle = ToolMode::kGrab;
    Scene grained = plain;
    grained.bodies[0].cut_wall_texture = 1;
    const ImageFrame labels = after(plain, opened, kOpenTicks, PictureKind::kLabels);
    const ImageFrame a = after(plain, opened, kOpenTicks), b = after(grained, opened, kOpenTicks);
    size_t on_walls = 0, walls = 0, elsewhere = 0;
    const auto isWallNear = [&](size_t pixel) {  // edges are mixed
      const int width = labels.width, column = static_cast<int>(pixel) % width, row = static_cast<int>(pixel) / width;
      for (int r = std::max(0, row - 1); r <= std::min(labels.height - 1, row + 1); ++r) {
        for (int c = std::max(0, column - 1); c <= std::min(width - 1, column + 1); ++c) {
          if (isWall(labels.labels[static_cast<size_t>(r * width + c)])) return true;
        }
      }
      return false;
    };
    for (const uint8_t label : labels.labels) walls += isWall(label) ? 1 : 0;
    for (const size_t i : changed(a, b)) ++(isWallNear(i) ? on_walls : elsewhere);
    EXPECT_GT(walls, 50U);
    EXPECT_GT(2 * on_walls, walls) << "supersampling " << supersampling;
    EXPECT_LE(elsewhere, on_walls / 50) << "supersampling " << supersampling << ": walls between pixels' middles";
  }
}

TEST_P(Appearance, SkinIsPalerWhereItIsPressedAndNowhereElse) {
  Scene plain = scene(), pale = plain;
  pale.bodies[0].blanching = 1;
  EXPECT_TRUE(after(plain).rgb == after(pale).rgb) << "at rest";
  const auto deep = [](int tick) {  // 14 mm: next to the ball springs are shortened by a twentieth
    const double share = std::min(1.0, static_cast<double>(tick) / kPressTicks);
    return leftAt({0, 0, kHalfM + kProbeRadiusM + 0.002 - 0.016 * share});
  };
  const ImageFrame pressed = after(plain, deep, kPressTicks), blanched = after(pale, deep, kPressTicks);
  const std::vector<size_t> pixels = changed(pressed, blanched);
  EXPECT_GT(pixels.size(), 200U);
  size_t paler = 0;
  for (const size_t i : pixels) paler += blanched.rgb[3 * i + 1] >= pressed.rgb[3 * i + 1] ? 1 : 0;
  EXPECT_GT(paler, pixels.size() * 99 / 100);
  double most = 0;
  for (const size_t i : pixels) most = std::max(most, double(blanched.rgb[3 * i + 1]) - pressed.rgb[3 * i + 1]);
  EXPECT_GT(most, 10) << "of green";
}

}  // namespace viscera
