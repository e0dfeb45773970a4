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

using Images = std::vector<ImageFrame>;

class Appearance : public OnSceneBackend {
 protected:
  /// Returns a block that fills much of an image.
  static Scene scene() {
    Scene scene = OnSceneBackend::scene();
    scene.bodies[0].spacing_m = 0.005;  // shades are compared to a step of 255
    CameraConfig& camera = scene.cameras[0];
    camera.position_m = Vector3d(0, -0.07, 0.08);
    camera.width_px = 160;
    camera.height_px = 120;
    camera.supersampling = 0;
    return scene;
  }
  /// Adds a camera with the view of the first one in which all samples are lit.
  static Scene alsoSupersampled(Scene scene) {
    scene.cameras.push_back(scene.cameras[0]);
    scene.cameras[1].name = "supersampled";
    scene.cameras[1].supersampling = 2;
    return scene;
  }
  /// Returns what each camera sees. @return [cameras]
  static Images pictures(Session& session, PictureKind kind = PictureKind::kColor) {
    FrameRequest outputs;
    outputs.of(kind).assign(session.scene().cameras.size(), true);
    Images out = session.show(outputs).images;
    EXPECT_EQ(out.size(), session.scene().cameras.size());
    std::sort(out.begin(), out.end(), [](const ImageFrame& a, const ImageFrame& b) { return a.camera < b.camera; });
    return out;
  }
  /// Returns what each camera sees after a stroke. @param labels  what is there, if asked for   @return [cameras]
  Images after(const Scene& scene, const StrokesByTick& strokes = {}, int ticks = 0, Images* labels = nullptr) {
    Session session(scene, context_);
    if (ticks > 0) play(session, strokes, ticks);
    session.drain();
    if (labels) *labels = pictures(session, PictureKind::kLabels);
    return pictures(session);
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
  const Scene plain = alsoSupersampled(scene());
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
  const Images alone = after(plain, press, kPressTicks), with = after(beside, press, kPressTicks);
  for (size_t c = 0; c < alone.size(); ++c) {
    ASSERT_EQ(alone[c].rgb.size(), with[c].rgb.size());
    int most = 0;
    for (size_t i = 0; i < alone[c].rgb.size(); ++i) most = std::max(most, std::abs(alone[c].rgb[i] - with[c].rgb[i]));
    EXPECT_LE(most, kRounded) << plain.cameras[c].name;
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
  const double face_m = 0.1;
  camera.target_m = camera.position_m + Vector3d(0, face_m, 0);
  const Vector3d eye_m = camera.position_m;
  lit.cameras.resize(4, camera);  // of which `camera` is none any more
  for (size_t c = 0; c < lit.cameras.size(); ++c) lit.cameras[c].name += std::to_string(c);
  lit.cameras[1].target_m = eye_m + Vector3d(0, face_m / 2, 0);
  lit.cameras[2].light_cone_deg = 20;
  lit.cameras[3].light = CameraLight::kLamp;
  const Images seen = after(lit);
  const ImageFrame &there = seen.at(0), &halfway = seen.at(1), &narrow = seen.at(2), &lamp = seen.at(3);
  const int column = 80, row = 60;
  EXPECT_NEAR(light(halfway, column, row, 0) / light(there, column, row, 0), 0.25, 0.25 * kShare);
  EXPECT_NEAR(light(narrow, column, row, 0) / light(there, column, row, 0), 1, 0.1) << "4 mm aside of 18 mm";
  // In the lower left corner, 13 mm to the side and 10 + 4 mm below the light; half a cone of 10 degrees is 17.6.
  const double tangent = std::tan(8.5 * M_PI / 180), half = std::tan(10 * M_PI / 180);
  const Eigen::Vector2d aside(-tangent * 160 / 120 * face_m - 0.0015, tangent * face_m + 0.004);
  const double faded = std::exp2(-aside.squaredNorm() / (half * half * face_m * face_m));
  EXPECT_NEAR(light(narrow, 0, 119, 0) / light(there, 0, 119, 0), faded, 0.1 * faded);
  const double as_lamp = light(there, column, row, 0) / light(lamp, column, row, 0);
  EXPECT_GT(as_lamp, 0.6) << "where it is set for";
  EXPECT_LT(as_lamp, 2.2) << "it comes from straight before the face, the lamp from aside";
}

TEST_P(Appearance, ContactShadowsAreWhereAToolIsNear) {
  Scene both = scene();
  both.cameras.push_back(both.cameras[0]);
  both.cameras[1].name = "shadows";
  both.cameras[1].contact_shadows = 1;
  const auto above = [](double gap_m) {
    return [gap_m](int) { return leftAt({0, 0, kHalfM + kProbeRadiusM + gap_m}); };
  };
  const Images beside = after(both, above(0.001), 1), away = after(both, above(0.05), 1);
  const ImageFrame &near = beside.at(0), &near_dark = beside.at(1), &far = away.at(0), &far_dark = away.at(1);
  const std::vector<size_t> pixels = changed(near, near_dark);
  EXPECT_GT(pixels.size(), 300U);
  for (const size_t i : pixels) EXPECT_LT(sumOf(near_dark, i), sumOf(near, i));
  double most = 0;
  for (const size_t i : pixels) most = std::max(most, sumOf(near, i) - sumOf(near_dark, i));
  EXPECT_GT(most, 60);
  double most_far = 0;
  for (const size_t i : changed(far, far_dark)) most_far = std::max(most_far, sumOf(far, i) - sumOf(far_dark, i));
  EXPECT_LT(most_far, 0.3 * most);
}

TEST_P(Appearance, LobulesAndBundlesAreOnWallsOfWoundsAlone) {
  Scene plain = scene();
  plain.cameras[0].position_m = Vector3d(0.01, -0.02, 0.1);
  plain.cameras[0].vertical_fov_deg = 25;
  plain.styluses[1].idle = ToolMode::kGrab;
  plain = alsoSupersampled(plain);
  Scene grained = plain;
  grained.bodies[0].cut_wall_texture = 1;
  Images all_labels;
  const Images without = after(plain, opened, kOpenTicks, &all_labels), with = after(grained, opened, kOpenTicks);
  for (size_t camera = 0; camera < with.size(); ++camera) {
    SCOPED_TRACE(plain.cameras[camera].name);
    const ImageFrame& labels = all_labels.at(camera);
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
    for (const size_t i : changed(without[camera], with[camera])) ++(isWallNear(i) ? on_walls : elsewhere);
    EXPECT_GT(walls, 50U);
    EXPECT_GT(2 * on_walls, walls);
    EXPECT_LE(elsewhere, on_walls / 50) << "walls between pixels' middles";
  }
}

TEST_P(Appearance, SkinIsPalerWhereItIsPressedAndNowhereElse) {
  Scene plain = scene(), pale = plain;
  pale.bodies[0].blanching = 1;
  const auto deep = [](int tick) {  // 14 mm: next to the ball springs are shortened by a twentieth
    const double share = std::min(1.0, static_cast<double>(tick) / kPressTicks);
    return leftAt({0, 0, kHalfM + kProbeRadiusM + 0.002 - 0.016 * share});
  };
  const auto atRestAndPressed = [&](const Scene& of) {
    Session session(of, context_);
    Images out = pictures(session);
    play(session, deep, kPressTicks);
    session.drain();
    out.push_back(picture(session));
    return out;
  };
  const Images of_plain = atRestAndPressed(plain), of_pale = atRestAndPressed(pale);
  EXPECT_TRUE(of_plain[0].rgb == of_pale[0].rgb) << "at rest";
  const ImageFrame &pressed = of_plain[1], &blanched = of_pale[1];
  const std::vector<size_t> pixels = changed(pressed, blanched);
  EXPECT_GT(pixels.size(), 200U);
  size_t paler = 0;
  for (const size_t i : pixels) paler += blanched.rgb[3 * i + 1] >= pressed.rgb[3 * i + 1] ? 1 : 0;
  EXPECT_GT(paler, pixels.size() * 99 / 100);
  double most = 0;
  for (const size_t i : pixels) most = std::max(most, double(blanched.rgb[3 * i + 1]) - pressed.rgb[3 * i + 1]);
  EXPECT_GT(most, 10) << "of green";
}

TEST_P(Appearance, PartsShowTheirOwnColorAndWoundsWithoutLayersTheirInside) {
  constexpr int kRounded = 1;      // of 255
  constexpr double kInside = 0.8;  // of the walls' pixels: their edge oozes, and borders are mixed with what is there
  const Vector3d blue(0.15, 0.25, 0.7);
  Scene body = scene();
  body.cameras[0].position_m = Vector3d(0.01, -0.02, 0.1);
  body.cameras[0].vertical_fov_deg = 25;
  body.styluses[1].idle = ToolMode::kGrab;
  body.bodies[0].layers.clear();
  body = alsoSupersampled(body);
  Scene part = body, fat = body;
  fat.bodies[0].layers = BodyConfig().layers;
  body.bodies[0].color = blue;
  PartConfig own;
  own.part = "box";
  own.young_modulus_pa = body.bodies[0].material.young_modulus_pa;
  own.poisson_ratio = body.bodies[0].material.poisson_ratio;
  own.density_kg_per_m3 = body.bodies[0].material.density_kg_per_m3;
  own.color = blue;
  part.bodies[0].parts = fat.bodies[0].parts = {own};
  Images all_labels;
  const Images of_parts = after(part, opened, kOpenTicks, &all_labels), of_bodies = after(body, opened, kOpenTicks),
               of_fats = after(fat, opened, kOpenTicks);
  for (size_t camera = 0; camera < of_parts.size(); ++camera) {
    SCOPED_TRACE(body.cameras[camera].name);
    const ImageFrame &labels = all_labels.at(camera), &of_body = of_bodies[camera], &of_part = of_parts[camera],
                     &of_fat = of_fats[camera];
    int most = 0;
    for (size_t i = 0; i < of_body.rgb.size(); ++i) most = std::max(most, std::abs(of_body.rgb[i] - of_part.rgb[i]));
    EXPECT_LE(most, kRounded);
    size_t walls = 0, blue_walls = 0, yellow_walls = 0;
    for (size_t i = 0; i < labels.labels.size(); ++i) {
      if (!isWall(labels.labels[i])) continue;
      ++walls;
      blue_walls += of_part.rgb[3 * i + 2] > of_part.rgb[3 * i] ? 1 : 0;
      yellow_walls += of_fat.rgb[3 * i] > of_fat.rgb[3 * i + 2] ? 1 : 0;
    }
    EXPECT_GT(walls, 50U);
    EXPECT_GT(static_cast<double>(blue_walls), kInside * static_cast<double>(walls));
    EXPECT_GT(yellow_walls, walls / 10) << "layers of skin and fat";
  }
}

/// Seen from above, where the lips of the cut are together: the block is not under tension.
TEST_P(Appearance, AClosedCutStaysAThinDarkRedLine) {
  constexpr double kLeastShare = 0.7;              // of the columns of the block
  constexpr int kWidest_px = 5, kNearest_px = 6;   // of the line; of its pixels to the middle of the cut
  constexpr double kDarker = 0.75, kRedder = 1.6;  // of the light before; red over green
  Scene above = scene();
  above.cameras[0].position_m = Vector3d(0, -0.0005, 0.1);
  above.cameras[0].vertical_fov_deg = 25;
  above.bodies[0].color = Vector3d(0.8, 0.58, 0.5);
  above = alsoSupersampled(above);
  const auto cutAndGone = [](int tick) { return tick <= kCutTicks ? cut(tick) : StylusSamples{}; };
  const Images before = after(above), ends = after(above, cutAndGone, kOpenTicks);
  for (size_t camera = 0; camera < ends.size(); ++camera) {
    SCOPED_TRACE(above.cameras[camera].name);
    const ImageFrame &whole = before[camera], &closed = ends[camera];
    std::vector<int> dark(static_cast<size_t>(whole.width), 0);
    std::vector<size_t> rows;
    for (const size_t i : changed(whole, closed)) {
      const bool line =
          sumOf(closed, i) < kDarker * sumOf(whole, i) && closed.rgb[3 * i] > kRedder * closed.rgb[3 * i + 1];
      if (!line) continue;
      ++dark[i % static_cast<size_t>(whole.width)];
      rows.push_back(i / static_cast<size_t>(whole.width));
    }
    ASSERT_FALSE(rows.empty());
    const auto [top, bottom] = std::minmax_element(rows.begin(), rows.end());
    EXPECT_LT(*bottom - *top, static_cast<size_t>(2 * kNearest_px));
    size_t columns = 0;
    for (const int pixels : dark) {
      columns += pixels > 0 ? 1 : 0;
      EXPECT_LE(pixels, kWidest_px);
    }
    const double px_m = 0.1 * 2 * std::tan(12.5 * M_PI / 180) / 120;
    EXPECT_GT(static_cast<double>(columns), kLeastShare * 2 * kHalfM / px_m);
  }
}

}  // namespace viscera
