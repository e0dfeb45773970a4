// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Tissue that a tool has left turned inside out is unfolded together with the suture in it (physics.md 3).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "math/vec4.h"
#include "session/block_session.h"
#include "solver/processes/suture/thread_bodies.h"

namespace viscera {
namespace {

using namespace test;

constexpr double kPusher_m = 0.5 * kHalfM;  // radius of the ball
constexpr size_t kRunningChannels = 10;

/// A block with a running suture along y, 8 mm below its top, where the ball goes through. Both tails are free.
Scene suturedBlock() {
  constexpr double kX_m = 0.01, kTail_m = 0.08, kDeep_m = 0.012, kFirst_m = -0.018, kApart_m = 0.004;
  Scene scene = blockScene();
  scene.solver.backend = Backend::kCpu;
  scene.solver.threads = 1;
  scene.styluses[0].probe.radius_m = kPusher_m;
  scene.bodies[0].material.cells = Cells::kSprings;  // those by moments push themselves open
  ThreadConfig thread;
  thread.position_m = Vector3d(kX_m, kFirst_m - kTail_m, kDeep_m);
  for (size_t k = 0; k < kRunningChannels; ++k) {
    const Vector3d place(kX_m, kFirst_m + kApart_m * static_cast<double>(k), kDeep_m);
    thread.path.push_back({place});
    thread.channels.push_back({"", place});
  }
  thread.path.push_back({Vector3d(kX_m, -kFirst_m + kTail_m, kDeep_m)});
  scene.threads = {thread};
  return scene;
}

/// From the tick on that unfolds the tissue.
struct Unfolded {
  bool seen = false, finite = true;
  size_t channels_before = 0, channels_first = 0, channels = 0;  ///< before it, at its end and at last
  double tension_n = 0;                                          ///< the largest
  double strayed = 0;                                            ///< of tissue, at last [spacings]
};

void note(const Session& session, Unfolded& out) {
  const ThreadBodies& threads = *findProcess<ThreadBodies>(session.solver());
  const Chain& chain = threads.chain(0);
  out.channels = threads.slides(0).size();
  if (session.solver().health().unfolded == 0) {
    out.channels_before = out.channels;
    return;
  }
  for (size_t i = 0; i < chain.nodes(); ++i)
    out.finite &= chain.places_m()[i].allFinite() && chain.velocities_m_per_s()[i].allFinite();
  for (size_t i = 0; i + 1 < chain.nodes(); ++i) out.tension_n = std::max(out.tension_n, std::abs(chain.tension_n(i)));
  if (!out.seen) out.channels_first = out.channels;
  out.seen = true;
}

/// A ball of two cells' radius goes through most of the block and out at its side.
Unfolded pushThroughSuture(const Scene& scene) {
  constexpr int kNear = 5, kDown = 20, kAside = 60, kGapTicks = 80;
  Session session(scene);
  Unfolded out;
  for (int t = 0; t < kNear; ++t)
    session.step(leftAt({0, 0, kHalfM + kPusher_m + 0.001 * (kNear - t)}), {});  // one that appears pushes nothing
  for (int t = 0; t <= kDown; ++t) session.step(leftAt({0, 0, kHalfM + kPusher_m - 1.6 * kHalfM * t / kDown}), {});
  for (int t = 0; t <= kAside + kGapTicks; ++t) {
    const bool there = t <= kAside;
    session.step(there ? leftAt({4 * kHalfM * t / kAside, 0, kPusher_m - 0.6 * kHalfM}) : StylusSamples{}, {});
    session.drain();
    note(session, out);
  }
  for (const layout::vec4& u : session.solver().readState().displacement_m)
    out.strayed = std::max(out.strayed, viscera::xyz(u).norm() / scene.bodies[0].spacing_m);
  return out;
}

TEST(UnfoldedSuture, StaysInItsChannelsAndTissueStaysUnfolded) {
  constexpr double kMost_n = 1, kUnfolded = 0.5;
  const Unfolded out = pushThroughSuture(suturedBlock());
  EXPECT_TRUE(out.seen && out.finite);
  EXPECT_EQ(out.channels_first, out.channels_before);
  EXPECT_LT(out.tension_n, kMost_n);
  EXPECT_LT(out.strayed, kUnfolded);
}

}  // namespace
}  // namespace viscera
