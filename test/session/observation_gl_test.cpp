// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <set>

#include "session/block_session.h"
#include "support/gpu_fixture.h"

namespace viscera {
namespace {

using namespace test;

class Observation : public GpuTest {
 protected:
  /// Returns a stroke that presses, then cuts: everything a session can do with one stylus.
  static StylusSamples pressAndCut(int tick) { return tick <= kPressTicks ? press(tick) : cut(tick - kPressTicks); }
  static constexpr int kTicks = kPressTicks + kCutTicks;
};

FrameRequest everything() {
  return {true, {true, true}};
}

TEST_F(Observation, WithoutViewersNothingIsMappedDrawnOrReadBack) {
  Session session(blockScene(), context_);
  const Frame frame = play(session, press, 10);
  const Counters counters = session.counters();
  EXPECT_EQ(counters.ticks, 10u);
  EXPECT_EQ(counters.substeps, session.solver().substepsDone());
  EXPECT_GE(counters.substeps, 10u * static_cast<uint64_t>(session.solver().substeps()));
  EXPECT_EQ(counters.mappings, 0u);
  EXPECT_EQ(counters.renders, 0u);
  EXPECT_EQ(counters.readbacks, 0u);
  EXPECT_FALSE(frame.surface);
  EXPECT_TRUE(frame.images.empty());
}

TEST_F(Observation, SurfaceAloneCostsOneMappingAndOneReadback) {
  Session session(blockScene(), context_);
  session.step({}, {true, {}});
  session.drain();
  EXPECT_EQ(session.counters().mappings, 1u);
  EXPECT_EQ(session.counters().renders, 0u);
  EXPECT_EQ(session.counters().readbacks, 1u);
}

TEST_F(Observation, SurfaceAndTwoCamerasShareOneMapping) {
  Scene scene = blockScene();
  scene.cameras.push_back(cameraOf("other"));
  Session session(scene, context_);
  session.step({}, everything());
  session.drain();
  EXPECT_EQ(session.counters().mappings, 1u);
  EXPECT_EQ(session.counters().renders, 2u);
  EXPECT_EQ(session.counters().readbacks, 3u);
}

TEST_F(Observation, OnlyTheWantedCameraGivesAnImageAndTheTissueIsInIt) {
  Scene scene = blockScene();
  scene.cameras.push_back(cameraOf("other"));
  Session session(scene, context_);
  std::vector<ImageFrame> images = session.step({}, {false, {false, true}}).images;
  if (images.empty()) images = session.drain().images;
  ASSERT_EQ(images.size(), 1u);
  const ImageFrame& image = images[0];
  EXPECT_EQ(image.camera, 1u);
  EXPECT_EQ(image.tick, 1u);
  ASSERT_EQ(image.rgb.size(), size_t{3} * 64 * 48);
  const uint8_t *corner = &image.rgb[0], *middle = &image.rgb[3 * (24 * 64 + 32)];
  EXPECT_FALSE(std::equal(corner, corner + 3, middle));
  EXPECT_GT(middle[0], middle[1]);  // tissue is red
  EXPECT_GT(middle[0], middle[2]);
}

TEST_F(Observation, FramesComeInOrderAndNoneIsLost) {
  Session session(blockScene(), context_);
  std::vector<uint64_t> image_ticks;
  uint64_t last_surface = 0;
  const auto take = [&](const Frame& frame) {
    for (const ImageFrame& image : frame.images) image_ticks.push_back(image.tick);
    if (!frame.surface) return;
    EXPECT_GT(frame.surface->tick, last_surface);
    last_surface = frame.surface->tick;
  };
  for (int t = 1; t <= 9; ++t) take(session.step(press(t), everything()));
  take(session.drain());  // there is room again for the output of the tenth tick
  take(session.step(press(10), everything()));
  take(session.drain());
  EXPECT_EQ(last_surface, 10u);
  EXPECT_EQ(image_ticks.size(), session.counters().renders);
  EXPECT_TRUE(std::is_sorted(image_ticks.begin(), image_ticks.end()));
  EXPECT_EQ(std::set<uint64_t>(image_ticks.begin(), image_ticks.end()).size(), image_ticks.size());
}

TEST_F(Observation, ForcesSurfacesAndImagesCarryTheTimeOfTheirPose) {
  Session session(blockScene(), context_);
  const SteadyTime begin{std::chrono::hours(1)};
  const auto received = [&](int tick) { return begin + std::chrono::milliseconds(tick); };
  const auto pressStamped = [&](int tick) {
    StylusSamples samples = press(tick);
    samples[0].received = received(tick);
    return samples;
  };
  const FrameRequest outputs = {true, {true}};
  Frame frame;
  const auto check = [&] {
    for (const ImageFrame& image : frame.images) EXPECT_EQ(image.pose_received, received(static_cast<int>(image.tick)));
    if (!frame.surface) return;
    EXPECT_EQ(frame.surface->pose_received, received(static_cast<int>(frame.surface->tick)));
  };
  for (int t = 1; t <= 5; ++t) {
    frame = session.step(pressStamped(t), outputs);
    check();
    EXPECT_EQ(frame.poses_received[0], received(t));  // the stability monitor waits for every tick
    EXPECT_EQ(frame.poses_received[1], SteadyTime{});
  }
  frame = session.drain();
  check();
  EXPECT_EQ(session.step({}, {}).poses_received[0], SteadyTime{});
  session.reset();
  EXPECT_EQ(session.drain().poses_received[0], SteadyTime{});
}

TEST_F(Observation, LateForceNamesItsPose) {
  Scene scene = blockScene();
  scene.solver.stability_monitor = false;  // no waiting for the measurements of a tick
  Session session(scene, context_);
  const SteadyTime begin{std::chrono::hours(1)};
  SteadyTime last{};
  constexpr int kTicks = 20;
  for (int t = 1; t <= kTicks; ++t) {
    StylusSamples samples = press(t);
    samples[0].received = begin + std::chrono::milliseconds(t);
    const SteadyTime now = session.step(samples, {}).poses_received[0];
    EXPECT_GE(now, last);
    EXPECT_LE(now, samples[0].received);
    last = now;
  }
  EXPECT_EQ(session.drain().poses_received[0], begin + std::chrono::milliseconds(kTicks));
}

TEST_F(Observation, SameInputGivesTheSameStateWhateverIsWatched) {
  const auto hashOf = [&](const FrameRequest& outputs) {
    Session session(blockScene(), context_);
    play(session, pressAndCut, kTicks, outputs);
    return session.stateHash();
  };
  const uint64_t unseen = hashOf({});
  EXPECT_EQ(hashOf({}), unseen);
  EXPECT_EQ(hashOf(everything()), unseen);
}

TEST_F(Observation, AnotherInputGivesAnotherState) {
  Session session(blockScene(), context_);
  play(session, pressAndCut, kTicks);
  const uint64_t hash = session.stateHash();
  session.reset();
  play(
      session, [](int tick) { return tick == 9 ? StylusSamples{} : pressAndCut(tick); }, kTicks);
  EXPECT_NE(session.stateHash(), hash);
}

TEST_F(Observation, StepsMakeNoOpenGlObject) {
  Session session(blockScene(), context_);
  play(session, pressAndCut, kTicks, everything());  // the first cut makes the shaders that draw lips
  session.reset();
  play(session, press, 2, everything());
  const size_t before = gpu::objectsCreated();
  play(session, pressAndCut, kTicks, everything());
  session.drain();
  EXPECT_EQ(gpu::objectsCreated(), before);
}

TEST_F(Observation, ImagesAreDueAtTheRateOfTheirCamera) {
  const std::vector<double> rates_hz = {30, 25, 60, 240, 20, 7, 1};
  Scene scene = blockScene();
  scene.bodies[0].spacing_m = 0.02;
  scene.cameras.clear();
  for (size_t c = 0; c < rates_hz.size(); ++c)
    scene.cameras.push_back(cameraOf("eye" + std::to_string(c), rates_hz[c]));
  Session session(scene, context_);
  constexpr int kSeconds = 2;
  const int ticks = kSeconds * static_cast<int>(scene.solver.tick_hz);
  std::vector<std::vector<int>> due(rates_hz.size());
  for (int t = 1; t <= ticks; ++t) {
    for (size_t c = 0; c < rates_hz.size(); ++c)
      if (session.imageDue(c)) due[c].push_back(t);
    session.step({}, {});
  }
  for (size_t c = 0; c < rates_hz.size(); ++c) {
    const double spacing = scene.solver.tick_hz / std::min(rates_hz[c], scene.solver.tick_hz);
    ASSERT_EQ(due[c].size(), static_cast<size_t>(std::lround(ticks / spacing))) << rates_hz[c];
    for (size_t i = 1; i < due[c].size(); ++i) {
      const int gap = due[c][i] - due[c][i - 1];
      EXPECT_TRUE(gap == std::floor(spacing) || gap == std::ceil(spacing)) << rates_hz[c] << " Hz, gap " << gap;
    }
  }
}

}  // namespace
}  // namespace viscera
