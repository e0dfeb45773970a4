// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "support/text.h"
#include "viscera/math/error.h"
#include "viscera/model/scene/scene.h"
#include "viscera/tools/strokes.h"

namespace viscera {
namespace {

constexpr double kHalfM = 0.02;      ///< half an edge of the box, which is centred on the origin
constexpr double kRoundingM = 1e-8;  ///< positions of the surface mesh are floats
constexpr double kRounding = 1e-9;   ///< rounding of unit vectors

BodyConfig box(const std::string& name) {
  BodyConfig body;
  body.name = name;
  body.source = TissueSource::kBox;
  body.box_size_m = Vector3d::Constant(2 * kHalfM);
  body.spacing_m = 0.01;
  return body;
}

const Model& boxModel() {
  static const Model model = buildModel([] {
    Scene scene;
    scene.bodies = {box("box")};
    return scene;
  }());
  return model;
}

/// Returns strokes with one key, anchored by a ray.
Strokes anchored(const Vector3d& from_m, const Vector3d& towards_m, const Pose& key = {}) {
  Strokes strokes;
  strokes.strokes.push_back({"left", {{0, key, false, false}}, Anchor{from_m, towards_m}});
  return strokes;
}

Pose resolved(const Vector3d& from_m, const Vector3d& towards_m, const Pose& key = {}) {
  Strokes strokes = anchored(from_m, towards_m, key);
  resolveAnchors(strokes, boxModel());
  EXPECT_FALSE(strokes.anchored());
  return strokes.strokes[0].keys[0].pose;
}

TEST(Anchor, FrameHasItsOriginAtTheHitAndZBackAlongTheRay) {
  const Pose frame = resolved({0.003, -0.3, 0.004}, {0.003, 0, 0.004});
  EXPECT_LT((frame.position_m - Vector3d(0.003, -kHalfM, 0.004)).norm(), kRoundingM);
  EXPECT_LT((frame.orientation * Vector3d::UnitX() - Vector3d(1, 0, 0)).norm(), kRounding);  // right
  EXPECT_LT((frame.orientation * Vector3d::UnitY() - Vector3d(0, 0, 1)).norm(), kRounding);  // up
  EXPECT_LT((frame.orientation * Vector3d::UnitZ() - Vector3d(0, -1, 0)).norm(), kRounding);
}

TEST(Anchor, KeysRelativeToPartsGetTheirPositions) {
  Strokes strokes =
      parseStrokes("strokes: [{stylus: left, keys: [{at: {part: box, offset_m: [0.01, 0, 0]}}]}]", "f.yaml");
  resolveAnchors(strokes, boxModel());
  EXPECT_FALSE(strokes.anchored());
  EXPECT_LT((strokes.strokes[0].keys[0].pose.position_m - Vector3d(0.01, 0, 0)).norm(), kRounding);
  Strokes unknown = parseStrokes("strokes: [{stylus: left, keys: [{at: {part: ball}}]}]", "f.yaml");
  EXPECT_TRUE(test::says(test::messageOf<StrokesError>([&] { resolveAnchors(unknown, boxModel()); }),
                         {"f.yaml", "'left'", "keys[0].at", "found 'ball'"}));
}

TEST(Anchor, KeysAreTakenFromTheirFrameIntoTheTissues) {
  const Pose key{Vector3d(0.1, 0.2, 0.3), rotationFromDegrees({0, 90, 0})};
  const Pose pose = resolved({0, -0.3, 0.004}, {0, 0, 0.004}, key);
  EXPECT_LT((pose.position_m - Vector3d(0.1, -kHalfM - 0.3, 0.204)).norm(), kRoundingM);
  // The key turns z of the frame into x of the frame, which is x of the tissue.
  EXPECT_LT((pose.orientation * Vector3d::UnitZ() - Vector3d(1, 0, 0)).norm(), kRounding);
}

TEST(Anchor, SlantedRayKeepsXHorizontalAndYUpwards) {
  const Vector3d towards(0.003, -0.001, 0.002);
  for (const Vector3d& from : {Vector3d(0.2, -0.3, 0.25), Vector3d(0.02, 0.01, 0.3), Vector3d(-0.2, 0.01, -0.3)}) {
    const Pose frame = resolved(from, towards);
    const Vector3d x = frame.orientation * Vector3d::UnitX(), y = frame.orientation * Vector3d::UnitY();
    EXPECT_LT((frame.orientation * Vector3d::UnitZ() - (from - towards).normalized()).norm(), kRounding);
    EXPECT_NEAR(x.z(), 0, kRounding);
    EXPECT_GT(y.z(), 0);
    EXPECT_NEAR(frame.position_m.cwiseAbs().maxCoeff(), kHalfM, kRoundingM);  // on the surface
  }
}

TEST(Anchor, RayFromStraightAboveHasAFrameToo) {
  const Pose frame = resolved({0.003, 0.004, 0.3}, {0.003, 0.004, 0});
  EXPECT_LT((frame.position_m - Vector3d(0.003, 0.004, kHalfM)).norm(), kRoundingM);
  EXPECT_LT((frame.orientation * Vector3d::UnitZ() - Vector3d::UnitZ()).norm(), kRounding);
  EXPECT_NEAR((frame.orientation * Vector3d::UnitX()).z(), 0, kRounding);
}

TEST(Anchor, RayDoesNotSlipBetweenTwoTriangles) {
  Scene scene;
  scene.bodies = {box("box")};
  scene.bodies[0].position_m = Vector3d(0.013, 0.007, 0.0021);
  const Model model = buildModel(scene);
  const TriangleMesh& mesh = model.bodies[0].skin.mesh;
  const Vector3d ray(0.31, -0.47, 0.93);
  for (const auto& triangle : mesh.triangles) {
    const Vector3d a = mesh.positions_m[triangle[0]].cast<double>(), b = mesh.positions_m[triangle[1]].cast<double>(),
                   c = mesh.positions_m[triangle[2]].cast<double>();
    if ((b - a).cross(c - a).dot(ray) >= 0) continue;  // the ray leaves the box here
    for (double share : {0.0, 0.123, 0.71}) {          // a vertex, and points on an edge
      const Vector3d target = a + share * (b - a);
      Strokes strokes = anchored(target - 0.3 * ray, target);
      resolveAnchors(strokes, model);
      EXPECT_LT((strokes.strokes[0].keys[0].pose.position_m - target).norm(), kRoundingM) << target.transpose();
    }
  }
}

/// Returns a fit to the box of the tests from a box `times` as large, for which the strokes were made.
OrganFit fitFrom(double times) {
  const Eigen::AlignedBox3d box_m(Vector3d::Constant(-kHalfM), Vector3d::Constant(kHalfM));
  return OrganFit::between({times * box_m.min(), times * box_m.max()}, box_m, Vector3d::UnitY());
}

TEST(Anchor, AndItsStrokesFollowAnOrganInThePlaceOfALargerOne) {
  Strokes strokes = anchored({0.03, -0.3, 0.02}, {0.03, 0, 0.02}, {Vector3d(0.004, 0, 0.008), {}});
  resolveAnchors(strokes, boxModel(), fitFrom(4));
  const Vector3d position(0.03 / 4, -kHalfM, 0.02 / 4), key(0.004 / 4, -0.008 / 4, 0);
  EXPECT_LT((strokes.strokes[0].keys[0].pose.position_m - position - key).norm(), kRoundingM);
}

TEST(Anchor, OfAnotherOrganMovesToWhereTheSkinIsBroadEnoughForAllStrokes) {
  // Two steps of the search: its candidates and the surface are on a grid.
  constexpr double kStepM = 2 * 2 * kHalfM / 95;
  constexpr double kSideM = 0.012;  // distance of the contacts of strokes to either side
  Strokes strokes = anchored({0.015, -0.3, 0.03}, {0.015, 0, 0.03});  // a ray above the box
  strokes.strokes[0].keys[0].pose.position_m.x() = kSideM;
  strokes.strokes.push_back(strokes.strokes[0]);
  strokes.strokes[1].keys[0].pose.position_m.x() = -kSideM;
  Strokes fitted = strokes;
  resolveAnchors(fitted, boxModel(), fitFrom(1));
  const Vector3d right = fitted.strokes[0].keys[0].pose.position_m, left = fitted.strokes[1].keys[0].pose.position_m;
  EXPECT_NEAR(right.x() - left.x(), 2 * kSideM, kRoundingM);  // their distance is unchanged
  EXPECT_NEAR(right.x(), kHalfM, kStepM);                     // they move no farther than necessary
  EXPECT_NEAR(right.z(), kHalfM, kStepM);
  EXPECT_NEAR(right.y(), -kHalfM, kRoundingM);
  EXPECT_THROW(resolveAnchors(strokes, boxModel()), StrokesError);  // on their own organ they do not move
}

/// Returns a box with its upper half held.
Model halfHeldBox() {
  Scene scene;
  scene.bodies = {box("box")};
  FixedConfig held;
  held.shape = FixedShape::kPlane;
  held.normal = Vector3d(0, 0, -1);
  scene.bodies[0].fixed = {held};
  return buildModel(scene);
}

TEST(Anchor, OfAnotherOrganMovesToWhereTheTissueIsFree) {
  constexpr double kCellM = 0.01;
  const Model model = halfHeldBox();
  Strokes strokes = anchored({0, -0.3, 0.015}, {0, 0, 0.015});
  EXPECT_TRUE(resolveAnchors(strokes, model, fitFrom(1)).empty());
  EXPECT_LT(strokes.strokes[0].keys[0].pose.position_m.z(), 0);
  EXPECT_GT(strokes.strokes[0].keys[0].pose.position_m.z(), -2 * kCellM) << "no farther than it must";
}

TEST(Anchor, OfAnotherOrganMovesToWhereTheTissueIsThick) {
  Scene scene;
  scene.bodies = {box("wall"), box("block")};  // side by side, with one front
  for (const double side : {-1.0, 1.0}) {
    BodyConfig& body = scene.bodies[side < 0 ? 0 : 1];
    body.box_size_m.y() = side < 0 ? 0.01 : 0.04;
    body.position_m = {side * (kHalfM + 0.001), side < 0 ? -0.015 : 0, 0};
  }
  const Model model = buildModel(scene);
  Strokes strokes = anchored({-0.005, -0.3, 0}, {-0.005, 0, 0}, {Vector3d(0, 0, -0.018), {}});
  resolveAnchors(strokes, model, fitFrom(1));
  const Vector3d key = strokes.strokes[0].keys[0].pose.position_m;
  EXPECT_GT(key.x(), 0) << "over the block";
  EXPECT_LT(key.x(), 0.006) << "no farther than it must";
  EXPECT_NEAR(key.y(), -kHalfM + 0.018, kRoundingM);
}

TEST(Anchor, StrokeThatMeetsOnlyHeldTissueIsNamed) {
  const Model model = halfHeldBox();
  Strokes strokes = anchored({0.001, -0.3, 0.015}, {0.001, 0, 0.015});
  strokes.strokes.push_back(strokes.strokes[0]);
  strokes.strokes[1].stylus = "right";
  strokes.strokes[1].keys[0].pose.position_m.y() = -0.03;  // below: free tissue
  const std::vector<std::string> notes = resolveAnchors(strokes, model);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_TRUE(test::says(notes[0], {"'left'", "[0.001, -0.02, 0.015]", "fixed tissue", "bodies[].fixed"}));
}

TEST(Anchor, RayStopsAtTheNearestBody) {
  Scene scene;
  scene.bodies = {box("far"), box("near")};
  scene.bodies[1].position_m = Vector3d(0, -0.1, 0);
  Strokes strokes = anchored({0.003, -0.3, 0.004}, {0.003, 0, 0.004});
  resolveAnchors(strokes, buildModel(scene));
  EXPECT_NEAR(strokes.strokes[0].keys[0].pose.position_m.y(), -0.1 - kHalfM, kRoundingM);
}

TEST(Anchor, RayThatMeetsNoTissueIsRefusedWithStylusAndRay) {
  const auto refusal = [](const Vector3d& from_m, const Vector3d& towards_m) {
    return test::messageOf<StrokesError>([&] {
      Strokes strokes = anchored(from_m, towards_m);
      resolveAnchors(strokes, boxModel());
    });
  };
  EXPECT_TRUE(
      test::says(refusal({0.5, -0.3, 0}, {0.5, 0, 0}), {"'left'", "[0.5, -0.3, 0]", "[0.5, 0, 0]", "no tissue"}));
  EXPECT_TRUE(test::says(refusal({0, -0.3, 0}, {0, -0.4, 0}), {"'left'", "no tissue"}));  // the box is behind
}

TEST(Anchor, StrokeWithoutOneStaysAsItIs) {
  Strokes strokes;
  strokes.strokes.push_back({"left", {{0, {Vector3d(1, 2, 3), Quaterniond::Identity()}, false, false}}, {}});
  resolveAnchors(strokes, boxModel());
  EXPECT_EQ(strokes.strokes[0].keys[0].pose.position_m, Vector3d(1, 2, 3));
}

TEST(StrokesYaml, ComesBackAsItWas) {
  constexpr double kDigits = 1e-8;          // nine digits are written
  constexpr double kNearTheLockRad = 3e-6;  // if y is within 1e-4 degrees of a right angle, x and z become one rotation
  Strokes strokes;
  strokes.strokes.push_back({"left", {}, {}});
  const Vector3d turns[] = {{0, 0, 0}, {10, 20, 30}, {-170, 80, 150}, {33, 90, 0}, {33, -90, 44}, {5, 89.99999, 7}};
  for (const Vector3d& turn : turns) {
    const double time_s = 0.123456789 * static_cast<double>(strokes.strokes[0].keys.size());
    const Pose pose{Vector3d(0.123456789, -1e-5, 3), rotationFromDegrees(turn)};
    strokes.strokes[0].keys.push_back({time_s, pose, turn.x() > 20, turn.y() > 20});
  }
  strokes.marks.push_back({"touch", 0.5});
  const Strokes back = parseStrokes(strokesYaml(strokes), "back");
  ASSERT_EQ(back.strokes.size(), 1u);
  EXPECT_EQ(back.strokes[0].stylus, "left");
  ASSERT_EQ(back.strokes[0].keys.size(), std::size(turns));
  for (size_t k = 0; k < std::size(turns); ++k) {
    const Stroke::Key &was = strokes.strokes[0].keys[k], &is = back.strokes[0].keys[k];
    EXPECT_NEAR(is.time_s, was.time_s, kDigits);
    EXPECT_LT((is.pose.position_m - was.pose.position_m).norm(), kDigits);
    EXPECT_LT(is.pose.orientation.angularDistance(was.pose.orientation), kNearTheLockRad) << turns[k].transpose();
    EXPECT_EQ(is.button1, was.button1);
    EXPECT_EQ(is.button2, was.button2);
  }
  ASSERT_EQ(back.marks.size(), 1u);
  EXPECT_EQ(back.marks[0].name, "touch");
  EXPECT_EQ(back.marks[0].time_s, 0.5);
}

}  // namespace
}  // namespace viscera
