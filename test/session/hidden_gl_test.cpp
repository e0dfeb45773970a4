// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Tissue that no camera sees is neither mapped nor drawn, and no image changes by it (docs/surface.md).
#include <gtest/gtest.h>

#include <cmath>

#include "session/block_session.h"
#include "session/inline_view.h"
#include "session/threaded_view.h"
#include "solver/tissue/joined_lattice.h"
#include "support/gpu_fixture.h"

namespace viscera {
namespace {

using namespace test;

CameraConfig cameraAt(const std::string& name, const Vector3d& position_m, const Vector3d& target_m) {
  CameraConfig camera = cameraOf(name);
  camera.position_m = position_m;
  camera.target_m = target_m;
  camera.width_px = 80;
  camera.height_px = 60;
  return camera;
}

/// Returns the block of the other tests, a ball next to it, a cloth behind both; cameras that see all, half of the
/// block, only the ball, and nothing.
Scene hiddenScene(bool draw_hidden, Mapping mapping = Mapping::kAuto, bool can_cut = true) {
  Scene scene = blockScene();
  scene.bodies[0].mapping = mapping;
  BodyConfig ball = scene.bodies[0];
  ball.name = "ball";
  ball.source = TissueSource::kBall;
  ball.position_m = Vector3d(0.12, 0, 0);
  BodyConfig cloth = scene.bodies[0];
  cloth.name = "cloth";
  cloth.source = TissueSource::kSheet;
  cloth.structure = Structure::kSurface;
  cloth.mapping = Mapping::kAuto;
  cloth.box_size_m = Vector3d(0.2, 0.2, 0.001);
  cloth.spacing_m = 0.01;
  cloth.position_m = Vector3d(0, 0.1, -0.02);
  scene.bodies.push_back(ball);
  scene.bodies.push_back(cloth);
  scene.bodies[2].fixed[0].point_m = Vector3d(-0.095, 0, 0);
  scene.bodies[2].fixed[0].normal = Vector3d(1, 0, 0);
  scene.styluses[0].button1 = ToolMode::kGrab;
  scene.styluses[0].button2 = can_cut ? ToolMode::kCut : ToolMode::kGrab;
  scene.styluses[1].button1 = scene.styluses[1].button2 = ToolMode::kGrab;
  scene.cameras = {
      cameraAt("all", {0.05, -0.6, 0.3}, {0.05, 0, 0}), cameraAt("half", {0.03, -0.1, 0.04}, {0.03, 0, 0.01}),
      cameraAt("ball", {0.12, -0.1, 0.03}, {0.125, 0, 0.02}), cameraAt("nothing", {0, -0.2, 0}, {0, -0.4, 0})};
  scene.cameras[1].vertical_fov_deg = 20;
  scene.cameras[2].vertical_fov_deg = 15;
  for (CameraConfig& camera : scene.cameras) camera.draw_hidden = draw_hidden;
  return scene;
}

/// Returns the requested images, which change from tick to tick: tissue unseen by one camera comes into view of
/// another.
FrameRequest outputsOf(int tick) {
  FrameRequest outputs;
  outputs.every_image = true;
  outputs.cameras = {tick % 7 == 3, tick % 2 == 0, tick % 3 == 0, tick % 5 == 0};
  outputs.surface = tick % 11 == 0;
  return outputs;
}

struct Shown {
  std::vector<ImageFrame> images;
  std::vector<SurfaceFrame> surfaces;
  ViewCounters counters;
};

void add(Pictures&& pictures, Shown& out) {
  for (ImageFrame& image : pictures.images) out.images.push_back(std::move(image));
  if (pictures.surface) out.surfaces.push_back(std::move(*pictures.surface));
}

void expectSame(const Shown& a, const Shown& b) {
  ASSERT_EQ(a.images.size(), b.images.size());
  for (size_t i = 0; i < a.images.size(); ++i) {
    ASSERT_EQ(a.images[i].tick, b.images[i].tick);
    ASSERT_EQ(a.images[i].camera, b.images[i].camera);
    EXPECT_TRUE(a.images[i].rgb == b.images[i].rgb) << "tick " << a.images[i].tick << ", camera " << a.images[i].camera;
  }
  ASSERT_EQ(a.surfaces.size(), b.surfaces.size());
  for (size_t i = 0; i < a.surfaces.size(); ++i) {
    EXPECT_TRUE(a.surfaces[i].positions_m == b.surfaces[i].positions_m) << "tick " << a.surfaces[i].tick;
    EXPECT_TRUE(a.surfaces[i].normals == b.surfaces[i].normals) << "tick " << a.surfaces[i].tick;
  }
}

/// Returns a grip of the top that is drawn aside by up to half an edge.
StylusSamples drag(int tick) {
  const double share = static_cast<double>(tick) / kCutTicks;
  return leftAt({share * kHalfM / 2, 0.001, kHalfM + 0.001}, false, true);
}

using Setting = std::tuple<Backend, Mapping>;
class Hidden : public GpuTest, public ::testing::WithParamInterface<Setting> {
 protected:
  /// Presses, then cuts if a tool can cut, or holds and drags.
  Shown played(bool draw_hidden, bool can_cut) {
    Scene scene = hiddenScene(draw_hidden, std::get<1>(GetParam()), can_cut);
    scene.solver.backend = std::get<0>(GetParam());
    Session session(scene, context_);
    Shown out;
    for (int tick = 1; tick <= kPressTicks + 2 * kCutTicks; ++tick) {
      const int stroke = tick - kPressTicks;
      const StylusSamples samples = stroke <= 0 ? press(tick) : can_cut ? cut(stroke) : drag(stroke);
      add(session.step(samples, outputsOf(tick)), out);
      add(session.drain(), out);
    }
    out.counters = session.counters();
    return out;
  }
};

TEST_P(Hidden, NoPictureDiffersWhileTissueMoves) {
  const Shown all = played(true, false), seen = played(false, false);
  expectSame(all, seen);
  EXPECT_EQ(all.counters.renders, seen.counters.renders);
  EXPECT_LT(seen.counters.mappings, all.counters.mappings);  // ticks in which only the camera "nothing" is used
}

TEST_P(Hidden, NoPictureDiffersWhileTissueIsCut) {
  const Shown all = played(true, true), seen = played(false, true);
  expectSame(all, seen);
}

INSTANTIATE_TEST_SUITE_P(Backends, Hidden,
                         ::testing::Combine(::testing::Values(Backend::kCpu, Backend::kGpu),
                                            ::testing::Values(Mapping::kAuto, Mapping::kInterpolated)));

/// Tissue on the host, positioned by the test.
class PlacedTissue : public Solver {
 public:
  explicit PlacedTissue(const Model& model) : model_(model), state_(restState(model)) {}
  /// Moves all tissue to an offset, about which it oscillates a little. @param tick  of the motion
  void put(const Vector3f& away_m, int tick) {
    for (size_t b = 0; b < model_.bodies.size(); ++b) {
      for (const uint32_t slot : model_.bodies[b].lattice.active_slots) {
        const float x = static_cast<float>(slot % 97) / 97, s = 0.002F * std::sin(0.7F * static_cast<float>(tick) + x);
        state_.displacement_m[model_.slotOffset(b) + slot] = {away_m.x() + s, away_m.y() + s * x, away_m.z() - s, 0};
      }
    }
  }
  void step(const ToolMotions&, const ObstacleMotions&) override {}
  void reset() override {}
  HostState readState() const override { return state_; }
  bool pollStats(layout::TickStats&, bool) override { return false; }
  const Health& health() const override { return health_; }
  double dt_s() const override { return 1; }
  double dtSafe_s() const override { return 1; }
  int substeps() const override { return 1; }
  uint64_t substepsDone() const override { return 0; }
  std::string backend() const override { return "placed"; }

 private:
  const Model& model_;
  HostState state_;
  Health health_;
};

class HiddenView : public GpuTest {
 protected:
  /// Returns the position of tissue that leaves every image and comes back on another path.
  static Vector3f positionAt(int tick) {
    const float offset = 0.04F * static_cast<float>(tick % 20 < 10 ? tick % 20 : 20 - tick % 20);
    return tick < 20 ? Vector3f(offset, 0, 0) : Vector3f(0, 0, -offset);
  }
  Shown shown(bool draw_hidden, Mapping mapping) {
    const Scene scene = hiddenScene(draw_hidden, mapping, false);
    const Model model = buildModel(scene);
    PlacedTissue tissue(model);
    Shown out;
    ThreadedView view(model, scene, context_);
    for (int tick = 1; tick <= 40; ++tick) {
      tissue.put(positionAt(tick), tick);
      RenderRequest request;
      request.tick = static_cast<uint64_t>(tick);
      request.outputs = outputsOf(tick);
      Pictures pictures;
      view.capture(tissue, request, pictures);
      view.collect(pictures, true);
      add(std::move(pictures), out);
    }
    out.counters = view.counters();
    return out;
  }
};

TEST_F(HiddenView, PicturesAreTheSameWhenTissueComesBackIntoView) {
  for (const Mapping mapping : {Mapping::kAuto, Mapping::kInterpolated, Mapping::kAlongNormal, Mapping::kOneToOne})
    expectSame(shown(true, mapping), shown(false, mapping));
}

TEST_F(HiddenView, WhatIsNotSeenIsNotMapped) {
  const Scene scene = hiddenScene(false);
  const Model model = buildModel(scene);
  PlacedTissue tissue(model);
  ThreadedView view(model, scene, context_);
  for (int tick = 1; tick <= 5; ++tick) {
    tissue.put(Vector3f::Zero(), tick);
    RenderRequest request;
    request.tick = static_cast<uint64_t>(tick);
    request.outputs.cameras = {false, false, false, true};
    Pictures pictures;
    view.capture(tissue, request, pictures);
    view.collect(pictures, true);
    ASSERT_EQ(pictures.images.size(), 1U);
  }
  EXPECT_EQ(view.counters().renders, 5U);
  EXPECT_EQ(view.counters().mappings, 0U);
}

}  // namespace
}  // namespace viscera
