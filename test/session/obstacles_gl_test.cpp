// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "viscera/gpu/context.h"
#include "viscera/session/session.h"
#include "viscera/solver/material.h"

using namespace viscera;

namespace {

/// Returns a weightless block over a plate on a frame, with a camera.
Scene liftScene(Backend backend) {
  Scene scene;
  scene.bodies.resize(1);
  scene.bodies[0].source = TissueSource::kBox;
  scene.bodies[0].box_size_m = Vector3d::Constant(0.02);
  scene.bodies[0].spacing_m = 0.005;
  scene.obstacles.resize(1);
  scene.obstacles[0].shape = ObstacleShape::kBox;
  scene.obstacles[0].size_m = Vector3d(0.1, 0.1, 0.01);
  scene.obstacles[0].frame = "lift";
  scene.environment.gravity_m_per_s2 = Vector3d::Zero();
  scene.cameras.resize(1);
  scene.cameras[0].width_px = 64;
  scene.cameras[0].height_px = 48;
  scene.solver.backend = backend;
  return scene;
}

Pose at(double height_m) {
  return {Vector3d(0, 0, height_m), Quaterniond::Identity()};
}

std::vector<uint8_t> picture(Session& session) {
  FrameRequest outputs;
  outputs.cameras = {true};
  outputs.every_image = true;
  Frame frame = session.step({}, outputs);
  if (frame.images.empty()) frame = session.drain();
  return frame.images.empty() ? std::vector<uint8_t>{} : frame.images.back().rgb;
}

}  // namespace

TEST(ObstaclesOfASession, GoWhereTheirFrameGoesInTissueAndPictures) {
  for (const Backend backend : {Backend::kGpu, Backend::kCpu}) {
    gpu::Context context;
    Session session(liftScene(backend), context);
    session.setObstacleFrame(0, at(-0.05));
    session.step({}, {});
    const uint64_t rest = session.stateHash();
    const std::vector<uint8_t> below = picture(session);
    ASSERT_FALSE(below.empty());
    EXPECT_EQ(session.stateHash(), rest);
    session.setObstacleFrame(0, at(-0.03));
    EXPECT_NE(picture(session), below);
    EXPECT_EQ(session.stateHash(), rest);
    session.setObstacleFrame(0, at(-0.013));
    session.step({}, {});
    session.step({}, {});
    EXPECT_NE(session.stateHash(), rest);
  }
}

/// A single wrong transform from tf: the plate is 10 cm higher for a tick.
TEST(ObstaclesOfASession, WhoseFrameGlitchesDoNotThrowTissue) {
  constexpr double kOver = 2.5;  // of the wave speed at rest: compressed to a half, waves are twice as fast
  for (const Backend backend : {Backend::kGpu, Backend::kCpu}) {
    gpu::Context context;
    Scene scene = liftScene(backend);
    scene.solver.tick_hz = 1000;
    Session session(scene, context);
    const auto stepAt = [&session](double height_m) {
      session.setObstacleFrame(0, at(height_m));
      session.step({}, {});
    };
    for (int t = 0; t < 10; ++t) stepAt(-0.016);
    EXPECT_EQ(session.extremes().obstacles_speed_limited, 0u);
    stepAt(-0.016 + 0.1);
    for (int t = 0; t < 20; ++t) stepAt(-0.016);
    session.drain();
    EXPECT_GT(session.extremes().obstacles_speed_limited, 0u);
    EXPECT_GT(session.extremes().max_speed_m_per_s, 0);  // it was touched
    EXPECT_LT(session.extremes().max_speed_m_per_s, kOver * waveSpeed(session.model()));
  }
}
