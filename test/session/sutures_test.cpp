// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Sutures together with tissue, in sessions.
#include <gtest/gtest.h>

#include <memory>

#include "session/block_session.h"
#include "session/session_recorder.h"
#include "session/session_replay.h"
#include "support/temporary_folder.h"
#include "viscera/math/error.h"
#include "viscera/session/tissue_processes.h"

namespace viscera {
namespace {

using namespace test;

Scene sutureScene() {
  Scene scene = blockScene();
  scene.solver.backend = Backend::kCpu;
  scene.environment.gravity_m_per_s2 = Vector3d(0, 0, -9.81);
  SutureConfig suture;
  suture.position_m = Vector3d(-0.05, 0, 0.06);
  suture.path = {{Vector3d(0.05, 0, 0.06)}};
  suture.start = SutureEnd::kFixed;
  scene.sutures = {suture};
  return scene;
}

/// Returns a stylus that takes the free end and draws it up.
StylusSamples drawUp(int tick) {
  StylusSamples out;
  out[0].valid = true;
  out[0].button1 = true;  // grab
  out[0].pose.position_m = Vector3d(0.05, 0, 0.06 + 5e-4 * tick);
  return out;
}

TEST(SutureSession, SuturesHangAndFollowTools) {
  Session session(sutureScene());
  for (int t = 1; t <= 40; ++t) session.step(drawUp(t), {});
  EXPECT_GT(suturePositions(session, 0).back().z(), 0.07);
  EXPECT_LT((suturePositions(session, 0)[0] - Vector3d(-0.05, 0, 0.06)).norm(), 1e-5);
}

TEST(SutureSession, ThreadsThatAreHeldPullAndDoNotPush) {
  Session session(sutureScene());
  for (int t = 1; t <= 40; ++t) EXPECT_EQ(session.step(drawUp(t), {}).contacts[0].kind, TickContact::Kind::kPulls) << t;
}

TEST(SutureSession, HashesKnowSuturesAndResetsPutThemBack) {
  Scene without = sutureScene();
  without.sutures.clear();
  Session one(sutureScene()), two(sutureScene()), bare(without);
  const uint64_t first = one.stateHash();
  for (int t = 1; t <= 20; ++t) {
    one.step(drawUp(t), {});
    two.step(drawUp(t), {});
    bare.step(drawUp(t), {});
  }
  EXPECT_EQ(one.stateHash(), two.stateHash());
  EXPECT_NE(one.stateHash(), bare.stateHash());
  EXPECT_EQ(viscera::stateHash(one.model(), one.solver().readState()), bare.stateHash());  // tissue is unchanged
  one.reset();
  EXPECT_EQ(one.stateHash(), first);
}

/// Returns a blade next to the block that cuts the suture.
StylusSamples cutSuture(int tick) {
  StylusSamples out;
  out[0] = {true, {{0.03, -0.01 + 0.001 * tick, 0.055}, Quaterniond::Identity()}, false, true};
  return out;
}

TEST(SutureSession, IsRecordedWithItsKnotsAndPieces) {
  const TemporaryFolder folder;
  Scene scene = sutureScene();
  scene.solver.threads = 1;
  scene.environment.gravity_m_per_s2.setZero();  // it stays in front of the blade
  uint64_t hash = 0;
  size_t pieces = 0;
  {
    Session session(scene);
    SessionRecorder recorder(folder.file("sutures.viscera"));
    recorder.follow(session);
    SutureTie tie;
    tie.knot = KnotKind::kSurgeons;
    session.tieSuture(0, tie);
    EXPECT_THROW(session.tieSuture(1, tie), Error);
    for (int t = 1; t <= 20; ++t) session.step(cutSuture(t), {});
    pieces = suturePieces(session);
    ASSERT_GT(pieces, 1U);  // more than one where the tie has folded it
    EXPECT_EQ(sutureOf(session, 1), 0U);
    hash = session.stateHash();
    recorder.leave();
  }
  SessionReplay replay(folder.file("sutures.viscera"));
  std::unique_ptr<Session> session;
  SessionReplay::Ports ports;
  ports.make = [&](const Scene& recorded, size_t) -> Session& {
    return *(session = std::make_unique<Session>(recorded));
  };
  ports.leaps = [](Session&) {};
  ports.outputs = [](const Session&) { return FrameRequest{}; };
  ports.stepped = [](Session&, Frame&&, double) {};
  replay.run(0, 1e9, {}, ports);
  EXPECT_EQ(session->stateHash(), hash);
  EXPECT_EQ(suturePieces(*session), pieces);
}

TEST(SutureSession, GoesOnFromASavedState) {
  const TemporaryFolder folder;
  Session one(sutureScene()), two(sutureScene());
  for (int t = 1; t <= 10; ++t) one.step(drawUp(t), {});
  one.save(folder.file("state"));
  two.restore(folder.file("state"));
  EXPECT_EQ(one.stateHash(), two.stateHash());
  for (int t = 11; t <= 20; ++t) {
    one.step(drawUp(t), {});
    two.step(drawUp(t), {});
  }
  EXPECT_EQ(one.stateHash(), two.stateHash());
}

}  // namespace
}  // namespace viscera
