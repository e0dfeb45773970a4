// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Sessions without OpenGL, compared with sessions with it.
#include <gtest/gtest.h>

#include "session/block_session.h"
#include "support/text.h"
#include "viscera/gpu/context.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

using namespace test;

constexpr float kPosition_m = 1e-6f;  ///< float rounding of positions of some centimetres

Scene cpuScene() {
  Scene scene = blockScene();
  scene.solver.backend = Backend::kCpu;
  return scene;
}

TEST(Headless, ScenesStepAndShowTheirSkinWithoutAContext) {
  Scene scene = blockScene();  // backend auto
  Session session(scene);
  EXPECT_NE(session.backendNote().find("no OpenGL context"), std::string::npos) << session.backendNote();
  const uint64_t rest = session.stateHash();
  play(session, cut, kCutTicks);
  const SurfaceFrame torn = surfaceAfter(session, {});
  EXPECT_EQ(torn.tick, static_cast<uint64_t>(kCutTicks) + 1);
  EXPECT_GT(torn.topology->triangleCount(), session.wholeSkin()->triangleCount());  // split, and with walls
  EXPECT_NE(session.stateHash(), rest);
  session.reset();
  EXPECT_EQ(surfaceAfter(session, {}).topology, session.wholeSkin());
  EXPECT_EQ(session.counters().mappings, 2u);
  EXPECT_EQ(session.counters().renders, 0u);
}

TEST(Headless, StateAndSkinAreThoseOfASessionWithAContext) {
  gpu::Context context;
  Session with(cpuScene(), context), without(cpuScene());
  for (Session* session : {&with, &without}) {
    play(*session, cut, kCutTicks);
    play(*session, press, kPressTicks);
  }
  EXPECT_EQ(without.stateHash(), with.stateHash());
  const SurfaceFrame on_gpu = surfaceAfter(with, press(kPressTicks));
  const SurfaceFrame on_host = surfaceAfter(without, press(kPressTicks));
  EXPECT_EQ(on_host.tick, on_gpu.tick);
  EXPECT_EQ(on_host.topology->triangles, on_gpu.topology->triangles);
  ASSERT_EQ(on_host.vertices(), on_gpu.vertices());
  for (size_t v = 0; v < on_host.vertices(); ++v) {
    ASSERT_LT((on_host.position_m(v) - on_gpu.position_m(v)).norm(), kPosition_m) << v;
  }
}

TEST(Headless, WhatNeedsAContextIsRefused) {
  Scene scene = blockScene();
  scene.solver.backend = Backend::kGpu;
  EXPECT_TRUE(says(messageOf<GpuError>([&] { Session session(scene); }), {"solver.backend", "OpenGL context"}));
  Session session(cpuScene());
  FrameRequest outputs;
  outputs.cameras = {true};
  EXPECT_TRUE(says(messageOf<GpuError>([&] { session.step({}, outputs); }), {"image", "OpenGL context"}));
}

}  // namespace
}  // namespace viscera
