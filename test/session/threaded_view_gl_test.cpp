// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "session/threaded_view.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <thread>

#include "session/block_session.h"
#include "session/inline_view.h"
#include "solver/tissue/joined_lattice.h"
#include "support/gpu_fixture.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

using namespace test;
using std::chrono::milliseconds;

/// Tissue on the host that oscillates: its state follows from the number of ticks, and costs nothing.
class SwayingTissue : public Solver {
 public:
  explicit SwayingTissue(const Model& model) : model_(model), state_(restState(model)) {}

  void step(const ToolMotions&, const ObstacleMotions&) override {
    ++tick_;
    if (still) return;
    const float sway_m = 0.002f * std::sin(0.3f * static_cast<float>(tick_));
    const Lattice& lattice = model_.bodies[0].lattice;
    for (uint32_t slot : lattice.active_slots) {
      const float height = static_cast<float>((lattice.restPosition(slot).z() + kHalfM) / kHalfM);
      state_.displacement_m[slot] = {sway_m * height, 0, 0.5f * sway_m * height * height, 0};
    }
  }
  /// Severs every spring of the upper nodes.
  void cut() {
    const Lattice& lattice = model_.bodies[0].lattice;
    state_.axial_cut.assign(3 * state_.nodes.size(), 0);
    for (uint32_t slot : lattice.active_slots) {
      for (uint32_t spring = 0; spring < layout::kSpringsPerNode; ++spring) {
        const int64_t other = lattice.neighborSlot(slot, spring);
        if (other < 0 ||
            std::max(lattice.restPosition(slot).z(), lattice.restPosition(static_cast<uint32_t>(other)).z()) < 0)
          continue;
        setSpringCount(state_.nodes[slot], spring, 0);
        state_.nodes[slot].lo |= layout::kSeveredBit;
      }
    }
    ++cut_revision_;
  }
  void reset() override {
    state_ = restState(model_);
    ++cut_revision_;
  }
  HostState readState() const override { return state_; }
  void snapshot(StateSnapshot& out) const override {
    ++snapshots;
    Solver::snapshot(out);
    if (broken) out.nodes.resize(out.nodes.size() + 1);
    out.cut_revision = cut_revision_;
  }
  bool pollStats(layout::TickStats&, bool) override { return false; }
  const Health& health() const override { return health_; }
  double dt_s() const override { return 1; }
  double dtSafe_s() const override { return 1; }
  int substeps() const override { return 1; }
  uint64_t substepsDone() const override { return tick_; }
  std::string backend() const override { return "swaying"; }

  bool still = false;
  bool broken = false;        ///< snapshots have more nodes than the model
  mutable int snapshots = 0;  ///< number of snapshots taken

 private:
  const Model& model_;
  HostState state_;
  Health health_;
  uint64_t tick_ = 0, cut_revision_ = 0;
};

Scene threadedViewScene() {
  Scene threadedViewScene = blockScene();
  threadedViewScene.cameras.push_back(cameraOf("other"));
  threadedViewScene.cameras[1].position_m = Vector3d(0.1, -0.1, 0.1);
  return threadedViewScene;
}

class ThreadedViewTest : public GpuTest {
 protected:
  explicit ThreadedViewTest(const Scene& threadedViewScene = viscera::threadedViewScene())
      : scene_(threadedViewScene), model_(buildModel(threadedViewScene)) {}

  /// Makes a tick, with a probe that wanders above the tissue.
  RenderRequest requestAfterStep(const FrameRequest& outputs) {
    RenderRequest request;
    request.tick = ++tick_;
    request.outputs = outputs;
    request.motions[0].mode = ToolMode::kProbe;
    request.motions[0].present = true;
    request.motions[0].to.position_m = Vector3d(0.0005 * static_cast<double>(tick_), 0, kHalfM + kProbeRadiusM);
    tissue_.step(request.motions, {});
    return request;
  }
  Pictures show(View& view, const RenderRequest& request) {
    Pictures out;
    view.capture(tissue_, request, out);
    view.collect(out, true);
    return out;
  }

  Scene scene_;
  Model model_;
  SwayingTissue tissue_{model_};
  uint64_t tick_ = 0;
};

FrameRequest threadedViewEverything() {
  return {true, {true, true}, false};
}

void expectSame(const Pictures& a, const Pictures& b) {
  ASSERT_TRUE(a.surface && b.surface);
  EXPECT_EQ(a.surface->tick, b.surface->tick);
  EXPECT_EQ(a.surface->positions_m, b.surface->positions_m);
  EXPECT_EQ(a.surface->normals, b.surface->normals);
  EXPECT_EQ(a.surface->topology->triangles, b.surface->topology->triangles);
  ASSERT_EQ(a.images.size(), b.images.size());
  for (size_t i = 0; i < a.images.size(); ++i) {
    EXPECT_EQ(a.images[i].tick, b.images[i].tick);
    EXPECT_EQ(a.images[i].camera, b.images[i].camera);
    EXPECT_EQ(a.images[i].rgb, b.images[i].rgb);
  }
}

/// Buffers that hold a state as a solver on the GPU would: it is unknown what moved.
struct GpuState {
  explicit GpuState(const Model& model)
      : displacement(model.slots()), nodes(model.slots()), bricks(allBricks(model)), bodies(bodyParams(model, 0)) {}
  StateView view(const HostState& state, uint64_t cut_revision) {
    displacement.write(state.displacement_m);
    nodes.write(state.nodes);
    StateView out;
    out.displacement = displacement.id();
    out.nodes = nodes.id();
    out.bricks = bricks.id();
    out.bodies = bodies.id();
    out.cut_revision = cut_revision;
    return out;
  }
  gpu::Buffer<layout::vec4> displacement;
  gpu::Buffer<layout::NodeBits> nodes;
  gpu::Buffer<layout::Brick> bricks;
  gpu::Buffer<layout::BodyParams> bodies;
};

TEST_F(ThreadedViewTest, ShowsToTheBitWhatAViewOnTheSteppersThreadShows) {
  constexpr int kTicks = 12, kCutTick = 5, kStillTick = 9;
  struct Shown {
    RenderRequest request;
    HostState state;
    uint64_t cut_revision;
    Pictures pictures;
  };
  std::vector<Shown> shown;
  {
    ThreadedView view(model_, scene_, context_);
    for (int t = 1; t <= kTicks; ++t) {
      if (t == kCutTick) tissue_.cut();
      tissue_.still = t >= kStillTick;
      const RenderRequest request = requestAfterStep(threadedViewEverything());
      Pictures pictures = show(view, request);
      shown.push_back({request, tissue_.readState(), t >= kCutTick ? 1u : 0u, std::move(pictures)});
    }
  }
  InlineView view(model_, scene_);  // the context belongs to this thread again
  GpuState gpu(model_);
  for (const Shown& s : shown) {
    Pictures pictures;
    view.wound(s.state, s.cut_revision);
    view.capture(gpu.view(s.state, s.cut_revision), s.request, pictures);
    view.collect(pictures, true);
    expectSame(s.pictures, pictures);
    ASSERT_FALSE(HasFailure()) << "tick " << s.request.tick;
  }
  EXPECT_NE(shown[1].pictures.images[0].rgb, shown[2].pictures.images[0].rgb);
}

/// While a large image is drawn, surfaces of later ticks arrive before it, and equal those of an idle view.
TEST_F(ThreadedViewTest, SurfacesDoNotWaitForImages) {
  if (!context_.isSoftware()) return;  // a GPU may draw any image in the time of a tick
  scene_.cameras.resize(1);
  scene_.cameras[0].width_px = scene_.cameras[0].height_px = 1400;
  scene_.cameras[0].position_m = Vector3d(0, -3 * kHalfM, 0);  // the block fills it
  ThreadedView view(model_, scene_, context_);
  show(view, requestAfterStep({true, {true}, false}));  // drivers compile shaders at the first image
  Pictures out;
  view.capture(tissue_, requestAfterStep({false, {true}, false}), out);
  const uint64_t image_tick = tick_;
  std::this_thread::sleep_for(milliseconds(50));  // the view takes it
  int surfaces = 0;
  while (out.images.empty()) {
    view.capture(tissue_, requestAfterStep({true, {}, false}), out);
    const uint64_t wanted = tick_;
    while (out.images.empty() && (!out.surface || out.surface->tick < wanted)) {
      std::this_thread::sleep_for(milliseconds(1));
      view.collect(out, false);
    }
    surfaces += out.images.empty() && out.surface && out.surface->tick > image_tick;
    out.surface.reset();
  }
  EXPECT_GT(surfaces, 0);
  ASSERT_EQ(out.images.size(), 1u);
  EXPECT_EQ(out.images[0].tick, image_tick);
}

TEST_F(ThreadedViewTest, WithoutViewersNothingIsCopied) {
  ThreadedView view(model_, scene_, context_);
  for (int t = 0; t < 10; ++t) {
    const Pictures pictures = show(view, requestAfterStep({false, {false, false}}));
    EXPECT_FALSE(pictures.surface);
    EXPECT_TRUE(pictures.images.empty());
  }
  EXPECT_EQ(tissue_.snapshots, 0);
  EXPECT_EQ(view.counters().mappings, 0u);
  EXPECT_EQ(view.counters().renders, 0u);
  EXPECT_EQ(view.counters().readbacks, 0u);
}

TEST_F(ThreadedViewTest, ImageIsNotDrawnAgainWhileNothingChanges) {
  ThreadedView view(model_, scene_, context_);
  RenderRequest request = requestAfterStep({false, {true, true}});
  const Pictures first = show(view, request);
  ASSERT_EQ(first.images.size(), 2u);
  EXPECT_EQ(view.counters().renders, 2u);
  tissue_.still = true;
  request.tick = 2;
  const Pictures second = show(view, request);
  ASSERT_EQ(second.images.size(), 2u);
  EXPECT_EQ(second.images[1].tick, 2u);
  for (size_t c = 0; c < 2; ++c) EXPECT_EQ(second.images[c].rgb, first.images[c].rgb) << c;
  EXPECT_EQ(view.counters().renders, 2u);
  EXPECT_EQ(view.counters().repeats, 2u);
  EXPECT_EQ(view.counters().mappings, 1u);
}

TEST_F(ThreadedViewTest, ImageIsDrawnAgainWhenToolsSpringsOrNodesChange) {
  ThreadedView view(model_, scene_, context_);
  const FrameRequest outputs = {false, {true}, false};
  RenderRequest request = requestAfterStep(outputs);
  std::vector<uint8_t> last = show(view, request).images.at(0).rgb;
  const auto expectAnother = [&](const char* what) {
    const std::vector<uint8_t> now = show(view, request).images.at(0).rgb;
    EXPECT_NE(now, last) << what;
    last = now;
  };
  request.motions[0].to.position_m.x() += 0.01;
  expectAnother("a tool is elsewhere");
  request.motions[0].mode = ToolMode::kCut;
  expectAnother("a tool does something else");
  request.motions[0].to.orientation = rotationFromDegrees({0, 40, 0});
  expectAnother("a tool is turned");
  request.motions[0].present = false;
  expectAnother("a tool is gone");
  tissue_.cut();
  expectAnother("springs are cut");
  request = requestAfterStep(outputs);
  expectAnother("nodes have moved and a tool is there");
  EXPECT_EQ(view.counters().repeats, 0u);
}

TEST_F(ThreadedViewTest, EveryImageThatMustComeComesInOrder) {
  ThreadedView view(model_, scene_, context_);
  FrameRequest outputs = {false, {true, true}, true};
  Pictures all;
  constexpr size_t kTicks = 30;
  for (size_t t = 0; t < kTicks; ++t) {
    view.capture(tissue_, requestAfterStep(outputs), all);
    view.collect(all, false);
  }
  view.collect(all, true);
  ASSERT_EQ(all.images.size(), 2 * kTicks);
  for (size_t i = 0; i < all.images.size(); ++i) {
    EXPECT_EQ(all.images[i].tick, 1 + i / 2);
    EXPECT_EQ(all.images[i].camera, i % 2);
  }
  EXPECT_EQ(view.counters().skipped, 0u);
}

TEST_F(ThreadedViewTest, ResetMakesWoundedSkinWhole) {
  ThreadedView view(model_, scene_, context_);
  const auto added = [&] {
    const Pictures pictures = show(view, requestAfterStep({true, {}, false}));
    return pictures.surface->topology->triangleCount() - view.wholeSkin()->triangleCount();
  };
  tissue_.cut();
  EXPECT_NE(added(), 0u);
  tissue_.reset();
  view.reset();
  EXPECT_EQ(added(), 0u);
}

/// Returns the niceness of the threads of this process.
std::map<std::string, int> niceOfThreads() {
  std::map<std::string, int> out;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/task")) {
    const std::string thread = entry.path().filename();
    std::string name;
    std::getline(std::ifstream(entry.path() / "comm"), name);
    out[name + ' ' + thread] = getpriority(PRIO_PROCESS, static_cast<id_t>(std::stoul(thread)));
  }
  return out;
}

TEST_F(ThreadedViewTest, DrawingYieldsToStepping) {
  const int own = getpriority(PRIO_PROCESS, 0);
  ThreadedView view(model_, scene_, context_);
  show(view, requestAfterStep(threadedViewEverything()));
  EXPECT_EQ(getpriority(PRIO_PROCESS, 0), own);
  int behind = 0;
  for (const auto& [thread, nice] : niceOfThreads()) {
    behind += nice > own ? 1 : 0;
    EXPECT_TRUE(nice > own || thread.rfind("llvmpipe-", 0) != 0) << thread;
  }
  EXPECT_GE(behind, 1);  // the view's own thread, and those that draw for it
}

TEST_F(ThreadedViewTest, ShowingMakesNoOpenGlObject) {
  ThreadedView view(model_, scene_, context_);
  show(view, requestAfterStep(threadedViewEverything()));
  const size_t before = gpu::objectsCreated();
  for (int t = 0; t < 5; ++t) show(view, requestAfterStep(threadedViewEverything()));
  EXPECT_EQ(gpu::objectsCreated(), before);
}

TEST_F(ThreadedViewTest, WhatGoesWrongOnItsThreadIsThrownToTheStepperFromThenOn) {
  ThreadedView view(model_, scene_, context_);
  show(view, requestAfterStep(threadedViewEverything()));
  tissue_.broken = true;
  tissue_.cut();  // so nodes are uploaded
  EXPECT_THROW(show(view, requestAfterStep(threadedViewEverything())), GpuError);
  EXPECT_THROW(show(view, requestAfterStep(threadedViewEverything())), GpuError);
  EXPECT_THROW(view.reset(), GpuError);
}

TEST_F(ThreadedViewTest, SceneThatCannotBeSeenIsRefusedAndTheContextComesBack) {
  scene_.cameras[0].target_m = scene_.cameras[0].position_m;
  EXPECT_THROW(ThreadedView(model_, scene_, context_), SceneError);
  scene_.cameras[0].target_m = Vector3d::Zero();
  EXPECT_NO_THROW(InlineView(model_, scene_));
  EXPECT_NO_THROW(gpu::checkErrors("after the refusal"));
}

/// Returns a scene with an image that takes a software rasteriser many ticks.
Scene slowScene() {
  Scene threadedViewScene = blockScene();
  threadedViewScene.cameras[0].width_px = 1920;
  threadedViewScene.cameras[0].height_px = 1080;
  return threadedViewScene;
}

class SlowView : public ThreadedViewTest {
 protected:
  SlowView() : ThreadedViewTest(slowScene()) {}

  /// Makes ticks of a millisecond that leave the processor to drawing. @returns their duration [s]
  double timeTicks(View& view, int ticks, const FrameRequest& outputs) {
    const auto begun = std::chrono::steady_clock::now();
    for (int t = 0; t < ticks; ++t) {
      Pictures out;
      std::this_thread::sleep_for(milliseconds(1));
      view.capture(tissue_, requestAfterStep(outputs), out);
      view.collect(out, false);
      images_ += out.images.size();
    }
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  }
  size_t images_ = 0;
};

TEST_F(SlowView, SlowsNoTick) {
  // Ticks that wait for images of tens of milliseconds would take more than ten times as long.
  constexpr double kSlower = 3;
  constexpr int kTicks = 300;
  ThreadedView view(model_, scene_, context_);
  const double unseen_s = timeTicks(view, kTicks, {});
  const double seen_s = timeTicks(view, kTicks, {true, {true}, false});
  EXPECT_LT(seen_s, kSlower * unseen_s);
  EXPECT_GT(images_, 0u);
}

TEST_F(SlowView, SkipsAndCountsWhatItCannotKeepUpWith) {
  ThreadedView view(model_, scene_, context_);
  constexpr int kTicks = 100;
  timeTicks(view, kTicks, {false, {true}, false});
  Pictures rest;
  view.collect(rest, true);
  const ViewCounters counters = view.counters();
  EXPECT_GT(counters.skipped, 0u);
  EXPECT_EQ(images_ + rest.images.size() + counters.skipped, static_cast<size_t>(kTicks));
  EXPECT_EQ(counters.readbacks, images_ + rest.images.size());
}

TEST_F(SlowView, RequestsThatAreOvertakenAreMetByTheNewerState) {
  ThreadedView view(model_, scene_, context_);
  Pictures out;
  view.capture(tissue_, requestAfterStep({false, {true}, false}), out);  // keeps the view busy
  std::this_thread::sleep_for(milliseconds(2));
  constexpr int kTicks = 4;
  for (int t = 0; t < kTicks; ++t) {
    view.capture(tissue_, requestAfterStep(t % 2 ? FrameRequest{true, {}, false} : FrameRequest{false, {true}, false}),
                 out);
  }
  view.collect(out, true);
  ASSERT_TRUE(out.surface);
  EXPECT_GE(out.surface->tick, 3u);  // 5, but a view on a busy machine may take the slot earlier
  ASSERT_FALSE(out.images.empty());
  EXPECT_GE(out.images.back().tick, 3u);
}

}  // namespace
}  // namespace viscera
