// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Sutures in images.
#include <gtest/gtest.h>

#include "session/block_session.h"
#include "viscera/gpu/context.h"
#include "viscera/layout/picture_labels.h"
#include "viscera/render/camera.h"
#include "viscera/session/tissue_processes.h"

namespace viscera {
namespace {

using namespace test;

/// Returns a blue suture above the block, fixed at its left end, that falls.
Scene blueSutureScene(Backend backend) {
  Scene scene = blockScene();
  scene.solver.backend = backend;
  scene.environment.gravity_m_per_s2 = Vector3d(0, 0, -9.81);
  scene.cameras = {cameraOf("eye")};
  SutureConfig suture;
  suture.material = SutureMaterial::kPolypropylene;
  suture.position_m = Vector3d(-0.03, 0, 0.05);
  suture.path = {{Vector3d(0.03, 0, 0.05)}};
  suture.start = SutureEnd::kFixed;
  scene.sutures = {suture};
  return scene;
}

struct Seen {
  std::vector<uint8_t> rgb, labels;
};

Seen picture(Session& session) {
  FrameRequest outputs;
  outputs.cameras = outputs.labels = {true};
  outputs.every_image = true;
  Seen out;
  for (const ImageFrame& image : session.show(outputs).images) {
    if (image.kind == PictureKind::kColor) out.rgb = image.rgb;
    if (image.kind == PictureKind::kLabels) out.labels = image.labels;
  }
  return out;
}

/// Returns the pixel of a node that a camera sees or would see; of others the number of pixels.
size_t pixelShowing(const CameraConfig& camera, const Vector3d& position_m) {
  const Intrinsics in = intrinsics(camera);
  const Vector3d at_m = opticalPose(camera).inverse() * position_m;
  const double column = in.fx * at_m.x() / at_m.z() + in.cx, row = in.fy * at_m.y() / at_m.z() + in.cy;
  const auto width = static_cast<size_t>(camera.width_px), height = static_cast<size_t>(camera.height_px);
  if (column < 0 || row < 0 || column >= camera.width_px || row >= camera.height_px) return width * height;
  return static_cast<size_t>(row) * width + static_cast<size_t>(column);
}

/// Returns the shares of the nodes with a pixel that is labelled as the suture, and that is blue.
std::pair<double, double> shares(const Seen& seen, const CameraConfig& camera,
                                 const std::vector<Vector3d>& positions_m) {
  double labelled = 0, blue = 0;
  for (const Vector3d& position_m : positions_m) {
    const size_t at = pixelShowing(camera, position_m);
    if (at >= seen.labels.size()) continue;
    labelled += seen.labels[at] == layout::kFirstSutureLabel;
    blue += seen.rgb[3 * at + 2] > seen.rgb[3 * at] + 10;
  }
  const auto nodes = static_cast<double>(positions_m.size());
  return {labelled / nodes, blue / nodes};
}

TEST(SuturesInPictures, AreWhereTheSuturesAreOnEitherBackend) {
  constexpr double kMost = 0.9;  // of nodes: a tube of a pixel and a half sometimes misses the centre of a pixel
  for (const Backend backend : {Backend::kGpu, Backend::kCpu}) {
    gpu::Context context;
    const Scene scene = blueSutureScene(backend);
    Session session(scene, context);
    const std::vector<Vector3d> before = suturePositions(session, 0);
    for (int ticks : {1, 8}) {
      Frame frame;
      for (int t = 0; t < ticks; ++t) frame = session.step({}, {});
      EXPECT_EQ(frame.sutures.at(0).positions_m, suturePositions(session, 0));
      const auto [labelled, blue] = shares(picture(session), scene.cameras[0], suturePositions(session, 0));
      EXPECT_GT(labelled, kMost) << ticks;
      EXPECT_GT(blue, kMost) << ticks;
    }
    EXPECT_LT(shares(picture(session), scene.cameras[0], before).first, 0.5) << "it has left where it was";
    session.reset();
    EXPECT_GT(shares(picture(session), scene.cameras[0], before).first, kMost) << "it is there again";
  }
}

TEST(SuturesInPictures, AreNotInScenesWithout) {
  gpu::Context context;
  Scene scene = blueSutureScene(Backend::kCpu);
  scene.sutures.clear();
  Session session(scene, context);
  EXPECT_TRUE(session.step({}, {}).sutures.empty());
  for (const uint8_t label : picture(session).labels) EXPECT_LT(label, layout::kFirstSutureLabel);
}

/// A stylus that draws the end of a suture up, and releases it.
TEST(SuturesOnTheGpu, ContactsAreOfTheTickThatTheyAreOf) {
  constexpr int kHeld = 20;
  constexpr double kStep_m = 5e-4, kFrom_m = 0.05;
  gpu::Context context;
  Session session(blueSutureScene(Backend::kGpu), context);
  int calls = 0;
  for (int t = 1; t <= kHeld + 10; ++t) {
    const TickContact contact = session.step(leftAt({0.03, 0, kFrom_m + kStep_m * t}, t <= kHeld), {}).contacts[0];
    const auto of = static_cast<int>(std::lround((contact.to_m.z() - kFrom_m) / kStep_m));
    if (of < 1 || of > kHeld) continue;
    ++calls;
    EXPECT_EQ(contact.kind, TickContact::Kind::kPulls)
        << "tick " << of << " in " << t;  // also where it was released since
  }
  EXPECT_GE(calls, kHeld);
}

}  // namespace
}  // namespace viscera
