// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Threads that are parted by blades and tied, by hands and without.
#include <gtest/gtest.h>

#include <cmath>

#include "math/archive.h"
#include "solver/processes/suture/thread_bodies.h"
#include "viscera/math/error.h"
#include "viscera/model/scene/scene.h"

namespace viscera {
namespace {

constexpr double kThreadPiecesTick_s = 1.0 / 60;
constexpr double kThreadPiecesPlace_m = 1e-5;  // of what is held

Scene piecesScene(const std::string& threads, const std::string& more = "") {
  return parseScene(
      "bodies: [{name: block, source: box}]\nstyluses: [{name: left, button1: grab, button2: cut}, {name: right}]\n" +
          threads + more,
      "test.yaml");
}

/// 60 mm of thread along x, both ends fixed.
Scene taut() {
  return piecesScene(
      "environment: {gravity_m_per_s2: [0, 0, 0]}\nthreads: [{name: suture, position_m: [-0.03, 0, 0], "
      "path: [{position_m: [0.03, 0, 0]}], start: fixed, end: fixed}]\n");
}

/// A blade along z that goes from y = -10 mm to 10 mm at x.
ToolMotions cutAt(double x_m, double z_m = -0.005) {
  ToolMotions out;
  out[0].present = true;
  out[0].mode = ToolMode::kCut;
  out[0].from.position_m = Vector3d(x_m, -0.01, z_m);
  out[0].to.position_m = Vector3d(x_m, 0.01, z_m);
  return out;
}

TEST(EdgeMeets, WhatCrossesItOnItsWayAndNothingElse) {
  const std::array<Vector3d, 2> edge = {Vector3d(0, 0, 0), Vector3d(0, 0, 1)};
  const auto link = [](double y, double x, double z) {
    return std::array<Vector3d, 2>{Vector3d(x - 1, y, z), Vector3d(x + 1, y, z)};
  };
  EXPECT_TRUE(edgeMeets(edge, link(-1, 0, 0.5), link(1, 0, 0.5)));
  EXPECT_TRUE(edgeMeets(edge, link(-1, 0.9, 0.5), link(1, -0.9, 0.5)));
  EXPECT_FALSE(edgeMeets(edge, link(-1, 0, 1.5), link(1, 0, 1.5)));   // before its end
  EXPECT_FALSE(edgeMeets(edge, link(-1, 2, 0.5), link(1, 2, 0.5)));   // beside it
  EXPECT_FALSE(edgeMeets(edge, link(-2, 0, 0.5), link(-1, 0, 0.5)));  // not as far
  EXPECT_FALSE(edgeMeets(edge, link(-1, 0, 0.5), link(-1, 0, 0.5)));  // still
}

TEST(ThreadBlades, PartThreadsWhereTheyMeetThem) {
  ThreadBodies threads(taut());
  threads.step(cutAt(0.01, 0.001), {});  // above it
  ASSERT_EQ(threads.count(), 1U);
  const size_t nodes = threads.chain(0).nodes();
  threads.step(cutAt(0.01), {});
  ASSERT_EQ(threads.count(), 2U);
  EXPECT_EQ(threads.chain(0).nodes() + threads.chain(1).nodes(), nodes + 1);
  EXPECT_EQ(threads.piece(1).thread, 0U);
  EXPECT_NEAR(threads.chain(0).places_m().back().x(), 0.01, threads.chain(0).link_m());
  for (int k = 0; k < 30; ++k) threads.step({}, {});
  EXPECT_LT((threads.chain(0).places_m().front() - Vector3d(-0.03, 0, 0)).norm(), kThreadPiecesPlace_m);
  EXPECT_LT((threads.chain(1).places_m().back() - Vector3d(0.03, 0, 0)).norm(),
            kThreadPiecesPlace_m);  // ends stay held
  threads.step(cutAt(0.02), {});    // pieces are parted too
  EXPECT_EQ(threads.count(), 3U);
  threads.reset();
  ASSERT_EQ(threads.count(), 1U);
  EXPECT_EQ(threads.chain(0).nodes(), nodes);
}

TEST(ThreadBlades, ScissorsPartWhatIsBetweenThemAsTheyClose) {
  const auto closing = [](double from_rad, double to_rad) {
    ToolMotions out;
    out[0].present = true;
    out[0].mode = ToolMode::kScissors;
    out[0].from.position_m = out[0].to.position_m = Vector3d(0.01, 0, -0.006);
    out[0].from.orientation = out[0].to.orientation =
        rotationFromDegrees({0, 0, 90});  // the thread is across the mouth
    out[0].mouth_rad = 0.7F;
    out[0].opens_from_rad = from_rad;
    out[0].opens_to_rad = to_rad;
    return out;
  };
  ThreadBodies threads(taut());
  threads.step(closing(0.6, 0.6), {});  // they stand
  EXPECT_EQ(threads.count(), 1U);
  threads.step(closing(0.6, 0.065), {});  // not as far as the thread
  EXPECT_EQ(threads.count(), 1U);
  threads.step(closing(0.065, 0.03), {});
  EXPECT_EQ(threads.count(), 2U);
}

TEST(ThreadBlades, PartAsManyAsTheyMayAndLeaveShortEndsWhole) {
  ThreadBodies threads(taut());
  for (int round = 0; round < 3; ++round) {
    for (double x_m = -0.0295; x_m < 0.0295; x_m += 0.001) threads.step(cutAt(x_m), {});
  }
  EXPECT_EQ(threads.count(), 1 + kMostParted);
  for (size_t p = 0; p < threads.count(); ++p) EXPECT_GE(threads.chain(p).nodes(), 3U) << p;
}

TEST(ThreadBlades, AHandKeepsThePieceThatItHolds) {
  Scene scene = taut();
  scene.threads[0].end = ThreadEnd::kFree;
  ThreadBodies threads(scene);
  ToolMotions grab;
  grab[1].present = grab[1].hold_begins = true;
  grab[1].mode = ToolMode::kGrab;
  grab[1].from.position_m = grab[1].to.position_m = Vector3d(0.025, 0, 0);
  threads.step(grab, {});
  ToolMotions both = cutAt(0.0);
  both[1] = grab[1];
  both[1].hold_begins = false;
  threads.step(both, {});
  ASSERT_EQ(threads.count(), 2U);
  both[0] = {};
  both[1].to.position_m = Vector3d(0.025, 0.01, 0);
  threads.step(both, {});
  both[1].from = both[1].to;
  for (int k = 0; k < 30; ++k) threads.step(both, {});
  double nearest_m = 1;
  for (const Vector3d& place : threads.chain(1).places_m())
    nearest_m = std::min(nearest_m, (place - both[1].to.position_m).norm());
  EXPECT_LT(nearest_m, 2 * kThreadPiecesPlace_m + threads.chain(1).link_m() / 2);
  StylusPulls pulls;
  threads.addPulls(pulls);
  EXPECT_EQ(pulls[1].nodes, 2U);
}

/// A loop about a post that stands on the origin, its tails beside each other on the side of -y.
Scene looped(const std::string& keys = "") {
  return piecesScene(
      "environment: {gravity_m_per_s2: [0, 0, 0]}\nobstacles: [{name: post, shape: capsule, radius_m: 0.005, "
      "length_m: 0.04}]\nthreads: [{name: tie, material: silk, usp: 3-0, position_m: [-0.012, -0.04, 0], path: "
      "[{position_m: [-0.003, -0.012, 0]}, {position_m: [-0.008, -0.005, 0]}, {position_m: [-0.008, 0.008, 0]}, "
      "{position_m: [0.008, 0.008, 0]}, "
      "{position_m: [0.008, -0.005, 0]}, {position_m: [0.003, -0.012, 0]}, {position_m: [0.012, -0.04, 0]}]" +
      keys + "}]\n");
}

void expectTied(const ThreadBodies& threads, double tension_n) {
  const SeenThread seen = threads.piece(0).seen();
  ASSERT_EQ(seen.knots.size(), 1U);
  EXPECT_TRUE(seen.knots[0].tied);
  // Round the post, and a little more: a hand's loop is drawn over it by friction too.
  EXPECT_GT(seen.knots[0].loop_m, 2 * M_PI * 0.005);
  EXPECT_LT(seen.knots[0].loop_m, 2 * M_PI * 0.005 * 1.25);
  EXPECT_GT(seen.knots[0].loop_n, 0.5 * tension_n);
  EXPECT_LT(seen.knots[0].loop_n, 1.5 * tension_n);
}

TEST(ThreadKnots, ALoopIsDrawnTightAndTied) {
  const Scene scene = looped();
  const ObstacleMotions still(1);
  ThreadBodies threads(scene);
  ThreadTie tie;
  tie.tension_n = 0.2;
  threads.tie(0, tie);
  for (int k = 0; k < 60 * 4; ++k) threads.step({}, still);
  expectTied(threads, 0.2);
  EXPECT_NEAR(threads.piece(0).seen().knots[0].holds_n,
              knotHolds(KnotKind::kSquare, 0, knotStrength(threads.chain(0).material().radius_m)), 1e-9);
  EXPECT_LT(threads.chain(0).worstLink(), 1e-3);
}

TEST(ThreadKnots, AScenesTiesComeAtTheirTimesAndTellWhyTheyDoNot) {
  const Scene scene = looped(", ties: [{at_s: 0, knot: surgeons, tension_n: 0.2, holds_n: 3}, {at_s: 3, knot: half}]");
  const ObstacleMotions still(1);
  ThreadBodies threads(scene);
  for (int k = 0; k < 60 * 3; ++k) threads.step({}, still);
  expectTied(threads, 0.2);
  EXPECT_EQ(threads.piece(0).seen().knots[0].kind, KnotKind::kSurgeons);
  EXPECT_EQ(threads.piece(0).seen().knots[0].holds_n, 3);
  EXPECT_EQ(threads.refused(), "");
  threads.step({}, still);
  EXPECT_EQ(threads.piece(0).seen().knots.size(), 2U);
  ThreadTie tie;
  for (int k = 0; k < 2; ++k) threads.tie(0, tie);
  EXPECT_THROW(threads.tie(0, tie), Error);  // as many as there may be
  EXPECT_THROW(threads.tie(1, tie), Error);

  const Scene short_one = piecesScene(
      "threads: [{name: short, position_m: [0, 0, 0], path: [{position_m: [0.003, 0, 0]}], ties: [{at_s: 0}]}]\n");
  ThreadBodies refusing(short_one);
  refusing.step({}, {});
  EXPECT_NE(refusing.refused().find("too few for a knot"), std::string::npos) << refusing.refused();
  tie.to = TieTo::kStrand;
  EXPECT_THROW(refusing.tie(0, tie), Error);  // without channels there is no strand between two
}

TEST(ThreadKnots, ALoopThatIsCutIsOpenAndAKnotInAPieceStays) {
  const Scene scene = looped();
  const ObstacleMotions still(1);
  ThreadBodies threads(scene);
  ThreadTie tie;
  threads.tie(0, tie);
  for (int k = 0; k < 60 * 3; ++k) threads.step({}, still);
  // off the tail that begins it: the knot is in the piece behind
  const Vector3d tail_m = threads.chain(0).places_m()[10];
  ToolMotions cut = cutAt(tail_m.x(), tail_m.z() - 0.005);
  cut[0].from.position_m.y() = tail_m.y();
  cut[0].to.position_m.y() = tail_m.y();
  cut[0].from.position_m.x() -= 0.004;
  cut[0].to.position_m.x() += 0.004;
  threads.step(cut, still);
  ASSERT_EQ(threads.count(), 2U);
  EXPECT_TRUE(threads.piece(0).seen().knots.empty());
  EXPECT_EQ(threads.piece(1).seen().knots.size(), 1U);
  // on the far side of the post: the loop
  ThreadBodies opened(scene);
  opened.tie(0, tie);
  for (int k = 0; k < 60 * 3; ++k) opened.step({}, still);
  ToolMotions across = cutAt(0, -0.005);
  across[0].from.position_m.y() = 0.004;
  across[0].to.position_m.y() = 0.02;
  opened.step(across, still);
  ASSERT_EQ(opened.count(), 2U);
  EXPECT_TRUE(opened.piece(0).seen().knots.empty());
  EXPECT_TRUE(opened.piece(1).seen().knots.empty());
}

TEST(ThreadKnots, PiecesAndKnotsGoOnFromASavedState) {
  const Scene scene = looped();
  const ObstacleMotions still(1);
  ThreadBodies one(scene), two(scene);
  ThreadTie tie;
  one.tie(0, tie);
  for (int k = 0; k < 20; ++k) one.step({}, still);
  ToolMotions cut = cutAt(0);
  cut[0].from.position_m = Vector3d(-0.03, -0.03, -0.005);
  cut[0].to.position_m = Vector3d(0.03, -0.03, -0.005);
  one.step(cut, still);
  ASSERT_GT(one.count(), 1U);
  Archive saved;
  one.persist(saved);
  Archive read(saved.sections());
  two.persist(read);
  read.end();
  EXPECT_EQ(hashWith(1, one), hashWith(1, two));
  for (int k = 0; k < 60; ++k) {
    one.step({}, still);
    two.step({}, still);
  }
  EXPECT_EQ(hashWith(1, one), hashWith(1, two));
  EXPECT_EQ(one.piece(0).seen().knots.size(), two.piece(0).seen().knots.size());
}

/// Two hands that each hold a tail of looped() near its end.
class TwoHands {
 public:
  explicit TwoHands(ThreadBodies& threads) : threads_(threads) {
    const std::vector<Vector3d>& places = threads.chain(0).places_m();
    at_[0] = places[2];
    at_[1] = places[places.size() - 3];
  }
  /// Straight to two places, at 50 mm/s.
  void go(const Vector3d& left_m, const Vector3d& right_m) {
    const std::array<Vector3d, 2> from = {at_[0], at_[1]}, to = {left_m, right_m};
    const double way_m = std::max((left_m - at_[0]).norm(), (right_m - at_[1]).norm());
    const int ticks = std::max(1, static_cast<int>(std::ceil(way_m / 0.05 / kThreadPiecesTick_s)));
    for (int k = 1; k <= ticks; ++k) {
      ToolMotions motions;
      for (size_t s = 0; s < 2; ++s) {
        motions[s].present = true;
        motions[s].mode = ToolMode::kGrab;
        motions[s].hold_begins = !holds_;
        motions[s].from.position_m = at_[s];
        at_[s] = from[s] + k * (to[s] - from[s]) / ticks;
        motions[s].to.position_m = at_[s];
      }
      holds_ = true;
      threads_.step(motions, ObstacleMotions(1));
    }
  }
  /// Each about the other, so that the tails wind about each other, then pulled apart. @param sense  1 or -1
  void throwOnce(int sense) {
    go({-0.015, -0.03, 0}, {0.015, -0.03, 0});
    go({0, -0.03, sense * 0.012}, {0, -0.03, -sense * 0.012});
    go({0.015, -0.03, 0}, {-0.015, -0.03, 0});
    go({0, -0.03, -sense * 0.012}, {0, -0.03, sense * 0.012});
    go({-0.03, -0.02, 0}, {0.03, -0.02, 0});
    go({-0.055, -0.015, 0}, {0.055, -0.015, 0});
  }

 private:
  ThreadBodies& threads_;
  std::array<Vector3d, 2> at_;
  bool holds_ = false;
};

TEST(ThreadKnots, ThrowsOfTwoHandsAreCountedAndTellKnotsApart) {
  for (const int second : {-1, 1}) {
    const Scene scene = looped();
    ThreadBodies threads(scene);
    TwoHands hands(threads);
    hands.throwOnce(1);
    SeenThread seen = threads.piece(0).seen();
    ASSERT_EQ(seen.knots.size(), 1U);
    EXPECT_EQ(seen.knots[0].kind, KnotKind::kHalf);
    EXPECT_FALSE(seen.knots[0].tied);
    hands.throwOnce(second);
    seen = threads.piece(0).seen();
    ASSERT_EQ(seen.knots.size(), 1U);
    ASSERT_EQ(seen.knots[0].turns.size(), 2U);
    EXPECT_EQ(seen.knots[0].kind, second < 0 ? KnotKind::kSquare : KnotKind::kGranny);
    EXPECT_TRUE(seen.knots[0].tied);
  }
}

}  // namespace
}  // namespace viscera
