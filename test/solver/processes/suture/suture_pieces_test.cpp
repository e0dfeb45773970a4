// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Sutures that are cut by blades, and tied, with and without styluses.
#include <gtest/gtest.h>

#include <cmath>

#include "math/archive.h"
#include "solver/processes/suture/suture_bodies.h"
#include "viscera/math/error.h"
#include "viscera/model/scene/scene.h"

namespace viscera {
namespace {

constexpr double kSuturePiecesTick_s = 1.0 / 60;
constexpr double kSuturePiecesPosition_m = 1e-5;  // of held nodes

Scene piecesScene(const std::string& sutures, const std::string& more = "") {
  return parseScene(
      "bodies: [{name: block, source: box}]\nstyluses: [{name: left, button1: grab, button2: cut}, {name: right}]\n" +
          sutures + more,
      "test.yaml");
}

/// Returns a scene with 60 mm of suture along x, both ends fixed.
Scene taut() {
  return piecesScene(
      "environment: {gravity_m_per_s2: [0, 0, 0]}\nsutures: [{name: suture, position_m: [-0.03, 0, 0], "
      "path: [{position_m: [0.03, 0, 0]}], start: fixed, end: fixed}]\n");
}

/// Returns a blade along z that moves from y = -10 mm to 10 mm at x.
ToolMotions cutAt(double x_m, double z_m = -0.005) {
  ToolMotions out;
  out[0].present = true;
  out[0].mode = ToolMode::kCut;
  out[0].from.position_m = Vector3d(x_m, -0.01, z_m);
  out[0].to.position_m = Vector3d(x_m, 0.01, z_m);
  return out;
}

TEST(EdgeMeets, FindsOnlyWhatCrossesTheEdge) {
  const std::array<Vector3d, 2> edge = {Vector3d(0, 0, 0), Vector3d(0, 0, 1)};
  const auto link = [](double y, double x, double z) {
    return std::array<Vector3d, 2>{Vector3d(x - 1, y, z), Vector3d(x + 1, y, z)};
  };
  EXPECT_TRUE(edgeMeets(edge, link(-1, 0, 0.5), link(1, 0, 0.5)));
  EXPECT_TRUE(edgeMeets(edge, link(-1, 0.9, 0.5), link(1, -0.9, 0.5)));
  EXPECT_FALSE(edgeMeets(edge, link(-1, 0, 1.5), link(1, 0, 1.5)));   // before its end
  EXPECT_FALSE(edgeMeets(edge, link(-1, 2, 0.5), link(1, 2, 0.5)));   // next to it
  EXPECT_FALSE(edgeMeets(edge, link(-2, 0, 0.5), link(-1, 0, 0.5)));  // not far enough
  EXPECT_FALSE(edgeMeets(edge, link(-1, 0, 0.5), link(-1, 0, 0.5)));  // at rest
}

TEST(SutureBlades, CutSuturesWhereTheyMeetThem) {
  SutureBodies sutures(taut());
  sutures.step(cutAt(0.01, 0.001), {});  // above it
  ASSERT_EQ(sutures.count(), 1U);
  const size_t nodes = sutures.chain(0).nodes();
  sutures.step(cutAt(0.01), {});
  ASSERT_EQ(sutures.count(), 2U);
  EXPECT_EQ(sutures.chain(0).nodes() + sutures.chain(1).nodes(), nodes + 1);
  EXPECT_EQ(sutures.piece(1).suture, 0U);
  EXPECT_NEAR(sutures.chain(0).positions_m().back().x(), 0.01, sutures.chain(0).link_m());
  for (int k = 0; k < 30; ++k) sutures.step({}, {});
  EXPECT_LT((sutures.chain(0).positions_m().front() - Vector3d(-0.03, 0, 0)).norm(), kSuturePiecesPosition_m);
  EXPECT_LT((sutures.chain(1).positions_m().back() - Vector3d(0.03, 0, 0)).norm(),
            kSuturePiecesPosition_m);  // ends stay held
  sutures.step(cutAt(0.02), {});       // pieces are cut too
  EXPECT_EQ(sutures.count(), 3U);
  sutures.reset();
  ASSERT_EQ(sutures.count(), 1U);
  EXPECT_EQ(sutures.chain(0).nodes(), nodes);
}

TEST(SutureBlades, ScissorsPartWhatIsBetweenThemAsTheyClose) {
  const auto closing = [](double from_rad, double to_rad) {
    ToolMotions out;
    out[0].present = true;
    out[0].mode = ToolMode::kScissors;
    out[0].from.position_m = out[0].to.position_m = Vector3d(0.01, 0, -0.006);
    out[0].from.orientation = out[0].to.orientation =
        rotationFromDegrees({0, 0, 90});  // the suture is across the mouth
    out[0].mouth_rad = 0.7F;
    out[0].opens_from_rad = from_rad;
    out[0].opens_to_rad = to_rad;
    return out;
  };
  SutureBodies sutures(taut());
  sutures.step(closing(0.6, 0.6), {});  // they do not move
  EXPECT_EQ(sutures.count(), 1U);
  sutures.step(closing(0.6, 0.065), {});  // not as far as the suture
  EXPECT_EQ(sutures.count(), 1U);
  sutures.step(closing(0.065, 0.03), {});
  EXPECT_EQ(sutures.count(), 2U);
}

TEST(SutureBlades, PartAsManyAsTheyMayAndLeaveShortEndsWhole) {
  SutureBodies sutures(taut());
  for (int round = 0; round < 3; ++round) {
    for (double x_m = -0.0295; x_m < 0.0295; x_m += 0.001) sutures.step(cutAt(x_m), {});
  }
  EXPECT_EQ(sutures.count(), 1 + kMostParted);
  for (size_t p = 0; p < sutures.count(); ++p) EXPECT_GE(sutures.chain(p).nodes(), 3U) << p;
}

TEST(SutureBlades, AToolKeepsThePieceThatItHolds) {
  Scene scene = taut();
  scene.sutures[0].end = SutureEnd::kFree;
  SutureBodies sutures(scene);
  ToolMotions grab;
  grab[1].present = grab[1].hold_begins = true;
  grab[1].mode = ToolMode::kGrab;
  grab[1].from.position_m = grab[1].to.position_m = Vector3d(0.025, 0, 0);
  sutures.step(grab, {});
  ToolMotions both = cutAt(0.0);
  both[1] = grab[1];
  both[1].hold_begins = false;
  sutures.step(both, {});
  ASSERT_EQ(sutures.count(), 2U);
  both[0] = {};
  both[1].to.position_m = Vector3d(0.025, 0.01, 0);
  sutures.step(both, {});
  both[1].from = both[1].to;
  for (int k = 0; k < 30; ++k) sutures.step(both, {});
  double nearest_m = 1;
  for (const Vector3d& position : sutures.chain(1).positions_m())
    nearest_m = std::min(nearest_m, (position - both[1].to.position_m).norm());
  EXPECT_LT(nearest_m, 2 * kSuturePiecesPosition_m + sutures.chain(1).link_m() / 2);
  StylusPulls pulls;
  sutures.addPulls(pulls);
  EXPECT_EQ(pulls[1].nodes, 2U);
}

/// Returns a loop about a post at the origin, its tails next to each other on the side of -y.
Scene looped(const std::string& keys = "") {
  return piecesScene(
      "environment: {gravity_m_per_s2: [0, 0, 0]}\nobstacles: [{name: post, shape: capsule, radius_m: 0.005, "
      "length_m: 0.04}]\nsutures: [{name: tie, material: silk, usp: 3-0, position_m: [-0.012, -0.04, 0], path: "
      "[{position_m: [-0.003, -0.012, 0]}, {position_m: [-0.008, -0.005, 0]}, {position_m: [-0.008, 0.008, 0]}, "
      "{position_m: [0.008, 0.008, 0]}, "
      "{position_m: [0.008, -0.005, 0]}, {position_m: [0.003, -0.012, 0]}, {position_m: [0.012, -0.04, 0]}]" +
      keys + "}]\n");
}

void expectTied(const SutureBodies& sutures, double tension_n) {
  const SutureState seen = sutures.piece(0).seen();
  ASSERT_EQ(seen.knots.size(), 1U);
  EXPECT_TRUE(seen.knots[0].tied);
  // Around the post, and a little more: friction, too, keeps a loop drawn by styluses from closing fully.
  EXPECT_GT(seen.knots[0].loop_m, 2 * M_PI * 0.005);
  EXPECT_LT(seen.knots[0].loop_m, 2 * M_PI * 0.005 * 1.25);
  EXPECT_GT(seen.knots[0].loop_n, 0.5 * tension_n);
  EXPECT_LT(seen.knots[0].loop_n, 1.5 * tension_n);
}

TEST(SutureKnots, ALoopIsDrawnTightAndTied) {
  const Scene scene = looped();
  const ObstacleMotions still(1);
  SutureBodies sutures(scene);
  SutureTie tie;
  tie.tension_n = 0.2;
  sutures.tie(0, tie);
  for (int k = 0; k < 60 * 4; ++k) sutures.step({}, still);
  expectTied(sutures, 0.2);
  EXPECT_NEAR(sutures.piece(0).seen().knots[0].holds_n,
              knotHolds(KnotKind::kSquare, 0, knotStrength(sutures.chain(0).material().radius_m)), 1e-9);
  EXPECT_LT(sutures.chain(0).worstLink(), 1e-3);
}

TEST(SutureKnots, TiesOfASceneHappenOnTimeOrStateTheirReason) {
  const Scene scene = looped(", ties: [{at_s: 0, knot: surgeons, tension_n: 0.2, holds_n: 3}, {at_s: 3, knot: half}]");
  const ObstacleMotions still(1);
  SutureBodies sutures(scene);
  for (int k = 0; k < 60 * 3; ++k) sutures.step({}, still);
  expectTied(sutures, 0.2);
  EXPECT_EQ(sutures.piece(0).seen().knots[0].kind, KnotKind::kSurgeons);
  EXPECT_EQ(sutures.piece(0).seen().knots[0].holds_n, 3);
  EXPECT_EQ(sutures.refused(), "");
  sutures.step({}, still);
  EXPECT_EQ(sutures.piece(0).seen().knots.size(), 2U);
  SutureTie tie;
  for (int k = 0; k < 2; ++k) sutures.tie(0, tie);
  EXPECT_THROW(sutures.tie(0, tie), Error);  // the largest number
  EXPECT_THROW(sutures.tie(1, tie), Error);

  const Scene short_one = piecesScene(
      "sutures: [{name: short, position_m: [0, 0, 0], path: [{position_m: [0.003, 0, 0]}], ties: [{at_s: 0}]}]\n");
  SutureBodies refusing(short_one);
  refusing.step({}, {});
  EXPECT_NE(refusing.refused().find("too few for a knot"), std::string::npos) << refusing.refused();
  tie.to = TieTo::kStrand;
  EXPECT_THROW(refusing.tie(0, tie), Error);  // without channels there is no strand between two
}

TEST(SutureKnots, ALoopThatIsCutIsOpenAndAKnotInAPieceStays) {
  const Scene scene = looped();
  const ObstacleMotions still(1);
  SutureBodies sutures(scene);
  SutureTie tie;
  sutures.tie(0, tie);
  for (int k = 0; k < 60 * 3; ++k) sutures.step({}, still);
  // off the tail that begins it: the knot is in the piece behind
  const Vector3d tail_m = sutures.chain(0).positions_m()[10];
  ToolMotions cut = cutAt(tail_m.x(), tail_m.z() - 0.005);
  cut[0].from.position_m.y() = tail_m.y();
  cut[0].to.position_m.y() = tail_m.y();
  cut[0].from.position_m.x() -= 0.004;
  cut[0].to.position_m.x() += 0.004;
  sutures.step(cut, still);
  ASSERT_EQ(sutures.count(), 2U);
  EXPECT_TRUE(sutures.piece(0).seen().knots.empty());
  EXPECT_EQ(sutures.piece(1).seen().knots.size(), 1U);
  // on the far side of the post: the loop
  SutureBodies opened(scene);
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

TEST(SutureKnots, PiecesAndKnotsGoOnFromASavedState) {
  const Scene scene = looped();
  const ObstacleMotions still(1);
  SutureBodies one(scene), two(scene);
  SutureTie tie;
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

/// Two styluses that each hold a tail of looped() near its end.
class TwoGrippers {
 public:
  explicit TwoGrippers(SutureBodies& sutures) : sutures_(sutures) {
    const std::vector<Vector3d>& positions = sutures.chain(0).positions_m();
    at_[0] = positions[2];
    at_[1] = positions[positions.size() - 3];
  }
  /// Moves straight to two positions, at 50 mm/s.
  void go(const Vector3d& left_m, const Vector3d& right_m) {
    const std::array<Vector3d, 2> from = {at_[0], at_[1]}, to = {left_m, right_m};
    const double offset_m = std::max((left_m - at_[0]).norm(), (right_m - at_[1]).norm());
    const int ticks = std::max(1, static_cast<int>(std::ceil(offset_m / 0.05 / kSuturePiecesTick_s)));
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
      sutures_.step(motions, ObstacleMotions(1));
    }
  }
  /// Moves each about the other, so the tails wind about each other, then pulls them apart. @param sense  1 or -1
  void throwOnce(int sense) {
    go({-0.015, -0.03, 0}, {0.015, -0.03, 0});
    go({0, -0.03, sense * 0.012}, {0, -0.03, -sense * 0.012});
    go({0.015, -0.03, 0}, {-0.015, -0.03, 0});
    go({0, -0.03, -sense * 0.012}, {0, -0.03, sense * 0.012});
    go({-0.03, -0.02, 0}, {0.03, -0.02, 0});
    go({-0.055, -0.015, 0}, {0.055, -0.015, 0});
  }

 private:
  SutureBodies& sutures_;
  std::array<Vector3d, 2> at_;
  bool holds_ = false;
};

TEST(SutureKnots, ThrowsOfTwoToolsDistinguishKnots) {
  for (const int second : {-1, 1}) {
    const Scene scene = looped();
    SutureBodies sutures(scene);
    TwoGrippers grippers(sutures);
    grippers.throwOnce(1);
    SutureState seen = sutures.piece(0).seen();
    ASSERT_EQ(seen.knots.size(), 1U);
    EXPECT_EQ(seen.knots[0].kind, KnotKind::kHalf);
    EXPECT_FALSE(seen.knots[0].tied);
    grippers.throwOnce(second);
    seen = sutures.piece(0).seen();
    ASSERT_EQ(seen.knots.size(), 1U);
    ASSERT_EQ(seen.knots[0].turns.size(), 2U);
    EXPECT_EQ(seen.knots[0].kind, second < 0 ? KnotKind::kSquare : KnotKind::kGranny);
    EXPECT_TRUE(seen.knots[0].tied);
  }
}

}  // namespace
}  // namespace viscera
