// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Marks on tissue in images (docs/surface.md, Marks): where they are on pressed and on cut tissue, and what they leave
// alone.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "session/on_backends.h"
#include "viscera/math/error.h"
#include "viscera/render/camera.h"

namespace viscera {
namespace {

using namespace test;

constexpr double kSpacing_m = 0.005;            // of the block's lattice, and of its surface mesh
constexpr double kHalfEdge_m = kSpacing_m / 2;  // the farthest that a mark may be from its place
constexpr double kCutPlane_m = 0.001;           // y of cut()
constexpr int kRestTicks = 60;                  // after which the block has come to rest

MarkConfig lineMark(const std::vector<Vector3d>& path_m) {
  MarkConfig mark;
  for (const Vector3d& at_m : path_m) mark.path.push_back({at_m});
  mark.normal = Vector3d::UnitZ();
  mark.color = Vector3d(0.05, 0.9, 0.05);  // unlike skin, flesh and the fat in walls of a cut
  return mark;
}

/// Lines on the top of the block: 4 mm from the cut, and across it.
std::vector<Vector3d> besideCut() {
  return {{-0.015, -0.003, kHalfM}, {0.015, -0.003, kHalfM}};
}
std::vector<Vector3d> acrossCut() {
  return {{0.004, -0.014, kHalfM}, {0.004, 0.009, kHalfM}};
}

class Marks : public OnSceneBackend {
 protected:
  static Scene scene(const std::vector<std::vector<Vector3d>>& lines = {besideCut(), acrossCut()}) {
    Scene scene = OnSceneBackend::scene();
    scene.bodies[0].spacing_m = kSpacing_m;
    for (const auto& line : lines) scene.marks.push_back(lineMark(line));
    CameraConfig& camera = scene.cameras[0];
    camera.position_m = Vector3d(0, -0.04, 0.1);
    camera.width_px = 320;
    camera.height_px = 240;
    return scene;
  }
};
VISCERA_ON_EVERY_BACKEND(Marks);

bool isGreen(const ImageFrame& image, size_t pixel) {
  const uint8_t* const rgb = &image.rgb[3 * pixel];
  return rgb[1] > 90 && rgb[0] < 0.6 * rgb[1] && rgb[2] < 0.6 * rgb[1];
}

/// Returns whether the depth jumps next to a pixel. Samples of such a pixel show both sides, but its depth is of one.
bool isAtSilhouette(const ImageFrame& depths, size_t pixel) {
  const auto width = static_cast<size_t>(depths.width);
  for (const size_t beside : {pixel - width, pixel - 1, pixel + 1, pixel + width}) {
    if (beside >= depths.depths_m.size()) continue;
    const double jump_m = std::abs(static_cast<double>(depths.depths_m[beside] - depths.depths_m[pixel]));
    if (!(jump_m < kHalfEdge_m)) return true;
  }
  return false;
}

/// Returns the positions on deformed tissue that green pixels show.
std::vector<Vector3d> greenPositions(const CameraConfig& camera, const ImageFrame& image, const ImageFrame& depths) {
  std::vector<Vector3d> out;
  const auto width = static_cast<size_t>(image.width);
  for (size_t i = 0; i < depths.depths_m.size(); ++i) {
    if (!isGreen(image, i) || std::isinf(depths.depths_m[i]) || isAtSilhouette(depths, i)) continue;
    const Eigen::Vector2d at(static_cast<double>(i % width) + 0.5, static_cast<double>(i / width) + 0.5);
    out.push_back(opticalPose(camera) * (depths.depths_m[i] * lineOfSight(camera, at)));
  }
  return out;
}

Vector3d cornerOf(const std::vector<float>& positions_m, uint32_t vertex) {
  return {positions_m[3 * vertex], positions_m[3 * vertex + 1], positions_m[3 * vertex + 2]};
}

/// Returns where a point of the block's top is now, by its triangle at rest. Of a triangle that the cut has divided, it
/// moves as the corners on its side do.
Vector3d movedTop(const Session& session, const SurfaceFrame& surface, const Vector3d& at_m, bool cut) {
  constexpr double kEdge = 1e-6;  // weights on an edge
  const std::vector<float> rest = restPositions(session);
  for (const auto& triangle : session.model().bodies[0].skin.mesh.triangles) {
    Vector3d corners[3], moved[3];
    for (size_t i = 0; i < 3; ++i) {
      corners[i] = cornerOf(rest, triangle[i]);
      moved[i] = cornerOf(surface.positions_m, triangle[i]);
    }
    const Vector3d u = corners[1] - corners[0], v = corners[2] - corners[0], normal = u.cross(v);
    if (normal.z() < 0.9 * normal.norm() || corners[0].z() < kHalfM - 1e-6) continue;
    const Vector3d off = at_m - corners[0];
    const double area = normal.z(), b = off.head<2>().dot(Eigen::Vector2d(v.y(), -v.x())) / area,
                 c = off.head<2>().dot(Eigen::Vector2d(-u.y(), u.x())) / area;
    if (b < -kEdge || c < -kEdge || b + c > 1 + kEdge) continue;
    const bool left = at_m.y() < kCutPlane_m;
    Vector3d sum = Vector3d::Zero();
    int count = 0;
    for (size_t i = 0; i < 3; ++i) {
      if ((corners[i].y() < kCutPlane_m) != left) continue;
      sum += moved[i] - corners[i];
      ++count;
    }
    if (cut && count > 0 && count < 3) return at_m + sum / count;
    return (1 - b - c) * moved[0] + b * moved[1] + c * moved[2];
  }
  ADD_FAILURE() << "no triangle at " << at_m.transpose();
  return at_m;
}

double nearest(const std::vector<Vector3d>& positions, const Vector3d& to_m) {
  double out = INFINITY;
  for (const Vector3d& position : positions) out = std::min(out, (position - to_m).norm());
  return out;
}

/// Compares the green pixels of the first camera with the lines on the deformed surface, both ways.
void expectAtPosition(Session& session, const ImageFrame& image, const ImageFrame& depths, bool cut) {
  FrameRequest outputs;
  outputs.surface = true;
  const Pictures pictures = session.show(outputs);
  ASSERT_TRUE(pictures.surface);
  std::vector<Vector3d> wanted;
  for (const MarkConfig& mark : session.scene().marks) {
    constexpr int kPoints = 60;
    for (int k = 0; k <= kPoints; ++k) {
      const Vector3d from = mark.path[0].position_m, to = mark.path[1].position_m;
      wanted.push_back(movedTop(session, *pictures.surface, from + (to - from) * k / kPoints, cut));
    }
  }
  const std::vector<Vector3d> seen = greenPositions(session.scene().cameras[0], image, depths);
  ASSERT_GT(seen.size(), 200U);
  double farthest_m = 0, missing_m = 0;
  for (const Vector3d& position : seen) farthest_m = std::max(farthest_m, nearest(wanted, position));
  for (const Vector3d& position : wanted) missing_m = std::max(missing_m, nearest(seen, position));
  EXPECT_LT(farthest_m, kHalfEdge_m);
  EXPECT_LT(missing_m, kHalfEdge_m);
  ::testing::Test::RecordProperty("farthest_um", static_cast<int>(1e6 * farthest_m));
  ::testing::Test::RecordProperty("missing_um", static_cast<int>(1e6 * missing_m));
}

/// A cut, after which the other stylus holds the far lip and draws it away.
StylusSamples openedCut(int tick) {
  if (tick <= kCutTicks) return cut(tick);
  const double offset_m = std::min(0.008, 0.0004 * (tick - kCutTicks));
  StylusSamples samples;
  samples[1] = {true, {Vector3d(-0.012, 0.016 + offset_m, kHalfM), Quaterniond::Identity()}, false, false};
  return samples;
}

}  // namespace

/// Weight along and across the block, some times that of Earth, shears and stretches it by more than half an edge.
TEST_P(Marks, AreWhereTheSurfaceIsOnTissueThatIsStretched) {
  Scene heavy = scene();
  heavy.environment.gravity_m_per_s2 = Vector3d(30, 0, 30);
  Session session(heavy, context_);
  expectAtPosition(session, picture(session), picture(session, PictureKind::kDepth), false);
  play(
      session, [](int) { return StylusSamples{}; }, kRestTicks);
  session.drain();
  FrameRequest outputs;
  outputs.surface = true;
  const Vector3d middle(0, -0.003, kHalfM);
  EXPECT_GT((movedTop(session, *session.show(outputs).surface, middle, false) - middle).norm(), kHalfEdge_m);
  expectAtPosition(session, picture(session), picture(session, PictureKind::kDepth), false);
}

TEST_P(Marks, PartWhereTheTissueIsCut) {
  Scene opened = scene();
  opened.styluses[1].idle = ToolMode::kGrab;
  opened.styluses[1].grab.radius_m = 0.008;
  Session session(opened, context_);
  play(session, openedCut, kCutTicks + kRestTicks);
  session.drain();
  FrameRequest outputs;
  outputs.surface = true;
  const Vector3d near(0.004, -0.004, kHalfM), far(0.004, 0.006, kHalfM);
  const Pictures pictures = session.show(outputs);
  const double apart_m =
      (movedTop(session, *pictures.surface, far, true) - movedTop(session, *pictures.surface, near, true)).norm();
  EXPECT_GT(apart_m, (far - near).norm() + kHalfEdge_m / 2) << "the cut has not opened";
  expectAtPosition(session, picture(session), picture(session, PictureKind::kDepth), true);
}

TEST_P(Marks, AreNotInDepthsLabelsOrTheState) {
  struct Seen {
    uint64_t state_hash;
    ImageFrame color, depths, labels;
  };
  const auto seen = [&](const Scene& scene) {
    Session session(scene, context_);
    play(session, cut, kCutTicks);
    session.drain();
    return Seen{session.stateHash(), picture(session), picture(session, PictureKind::kDepth),
                picture(session, PictureKind::kLabels)};
  };
  const Seen with = seen(scene()), without = seen(scene({}));
  EXPECT_EQ(with.state_hash, without.state_hash);
  EXPECT_EQ(with.depths.depths_m, without.depths.depths_m);
  EXPECT_EQ(with.labels.labels, without.labels.labels);
  EXPECT_NE(with.color.rgb, without.color.rgb);
}

TEST_P(Marks, AreShownToTheRightEyeToo) {
  Scene stereo = scene();
  stereo.cameras[0].stereo_baseline_m = 0.006;
  Session session(stereo, context_);
  const ImageFrame right = picture(session, PictureKind::kRight);
  size_t green = 0;
  for (size_t i = 0; 3 * i < right.rgb.size(); ++i) green += isGreen(right, i);
  EXPECT_GT(green, 200U);
}

TEST_P(Marks, OfAUserComeAndGoWithoutOthers) {
  Session session(scene({}), context_);
  const ImageFrame none = picture(session);
  session.showMarks({lineMark(besideCut())});
  const ImageFrame one = picture(session);
  EXPECT_NE(one.rgb, none.rgb);
  MarkConfig crossed = lineMark(besideCut());
  crossed.pattern = MarkPattern::kCrossed;
  session.showMarks({crossed});
  EXPECT_NE(picture(session).rgb, one.rgb);
  const uint64_t repeats = session.counters().repeats;
  picture(session);
  if (GetParam() == Backend::kCpu) {
    EXPECT_EQ(session.counters().repeats, repeats + 1) << "nothing has changed, so nothing is drawn";
  }
  session.showMarks({});
  constexpr int kRounded = 1;  // of 255: other shaders round differently
  const ImageFrame again = picture(session);
  int most = 0;
  for (size_t i = 0; i < none.rgb.size(); ++i) most = std::max(most, std::abs(again.rgb[i] - none.rgb[i]));
  EXPECT_LE(most, kRounded);
}

TEST_P(Marks, OfEveryKindAreSeenWithTheirPatterns) {
  std::vector<size_t> counts;
  Session session(scene({}), context_);
  for (const MarkKind kind : {MarkKind::kLine, MarkKind::kCircle, MarkKind::kRing, MarkKind::kTarget}) {
    for (const MarkPattern pattern :
         {MarkPattern::kSolid, MarkPattern::kDashed, MarkPattern::kDouble, MarkPattern::kCrossed, MarkPattern::kThin}) {
      MarkConfig one = lineMark(besideCut());
      one.kind = kind;
      one.pattern = pattern;
      one.center_m = Vector3d(0, 0, kind == MarkKind::kRing ? 0 : kHalfM);
      if (kind == MarkKind::kRing) one.normal = Vector3d::UnitY();
      one.radius_m = kind == MarkKind::kRing ? 2 * kHalfM : 0.008;
      session.showMarks({one});
      const ImageFrame image = picture(session);
      size_t green = 0;
      for (size_t i = 0; 3 * i < image.rgb.size(); ++i) green += isGreen(image, i);
      EXPECT_GT(green, 40U) << static_cast<int>(kind) << " " << static_cast<int>(pattern);
      counts.push_back(green);
    }
  }
  for (size_t i = 1; i < counts.size(); ++i) EXPECT_NE(counts[i], counts[i - 1]) << i;
}

TEST_P(Marks, OfAClothAreSeenToo) {
  Scene cloth = scene({});
  cloth.bodies[0].structure = Structure::kSurface;
  cloth.bodies[0].source = TissueSource::kSheet;
  cloth.bodies[0].fixed.clear();
  Session session(cloth, context_);
  const ImageFrame none = picture(session);
  session.showMarks({lineMark(besideCut())});
  EXPECT_NE(picture(session).rgb, none.rgb);
}

TEST_P(Marks, ThatMeetNoSurfaceAreRefused) {
  Scene far = scene({{{1, 0, 0}, {1, 1, 0}}});
  try {
    Session session(far, context_);
    FAIL() << "a mark 1 m away was taken";
  } catch (const SceneError& error) {
    EXPECT_NE(std::string(error.what()).find("marks[0]: a position of the mark is"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("at most 0.05 m is accepted"), std::string::npos) << error.what();
  }
  Scene ring = scene({besideCut()});
  ring.marks[0].kind = MarkKind::kRing;
  ring.marks[0].radius_m = 0.01;  // the block's surface is 2 cm from its centre
  EXPECT_THROW(Session(ring, context_), SceneError);
}

}  // namespace viscera
