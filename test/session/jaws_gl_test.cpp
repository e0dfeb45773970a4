// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Tools with jaws: clips on a bar, and a grasper that holds tissue between its fingers by friction.
#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "math/archive.h"
#include "session/on_backends.h"
#include "viscera/layout/picture_labels.h"
#include "viscera/session/tissue_processes.h"

namespace viscera {
namespace {

using namespace test;

constexpr double kJawsSide_m = 0.008;  // of the bar
constexpr double kRounding_m = 1e-4;   // of sides that yield a little between substeps, in addition to kMostSqueezed
constexpr double kAside_m = 0.003;     // 1.5 spacings: largest sideways distance of two nodes of a column
constexpr int kJawsClosing = 20, kJawsOpen = 4, kRests = 30;  // ticks
constexpr double kStill_per_s = 40;           // drag: squeezed tissue makes the bar swing when it is cut
constexpr double kMostSqueezed = 0.4;         // Clips::kMostSqueezed
constexpr double kRated_n = 3, kSlips = 0.1;  // of a grasper; share by which its force may vary as tissue slides
constexpr double kJaw_m = 0.006;              // sliding distance
constexpr double kLost_m = 0.0015;            // tolerance of it: stretch of the tissue in the meantime

class ClipSession : public OnSceneBackend {
 protected:
  static Scene barScene(Structure structure = Structure::kLattice) {
    Scene out = scene();
    BodyConfig& body = out.bodies[0];
    body.source = structure == Structure::kSurface ? TissueSource::kSheet : TissueSource::kBox;
    body.structure = structure;
    body.box_size_m = {0.04, kJawsSide_m, structure == Structure::kSurface ? 0 : kJawsSide_m};
    body.spacing_m = 0.002;
    body.fixed.resize(1);
    body.fixed[0].shape = FixedShape::kPlane;
    body.fixed[0].point_m = {-0.017, 0, 0};
    body.fixed[0].normal = {1, 0, 0};
    out.environment.gravity_m_per_s2 = Vector3d::Zero();
    out.styluses[0].idle = ToolMode::kNone;
    out.styluses[0].button1 = ToolMode::kClip;
    out.styluses[0].button2 = ToolMode::kCut;
    out.styluses[0].cut.blade_length_m = 0.03;
    return out;
  }
  /// Returns a tool from above across the bar, its tips beyond it.
  static StylusSamples at(double x_m, bool closes, bool cuts = false, double y_m = 0) {
    StylusSamples out{};
    out[0].valid = true;
    out[0].pose.position_m = {x_m, y_m, -0.006};
    out[0].pose.orientation = Quaterniond(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitZ()));
    out[0].button1 = closes;
    out[0].button2 = cuts;
    return out;
  }
  static void clip(Session& session, double x_m, double y_m = 0) {
    for (int t = 0; t < kJawsOpen; ++t) session.step(at(x_m, false, false, y_m), {});
    for (int t = 0; t < kJawsClosing; ++t) session.step(at(x_m, true, false, y_m), {});
    for (int t = 0; t < kJawsOpen; ++t) session.step(at(x_m, false, false, y_m), {});
  }
};

TEST_P(ClipSession, HoldsTwoSidesOfEveryKindOfTissueTogether) {
  for (const Structure structure : {Structure::kLattice, Structure::kExplicit, Structure::kSurface}) {
    SCOPED_TRACE(static_cast<int>(structure));
    Session session(barScene(structure), context_);
    clip(session, 0.006);
    const ClipStates clips = seenClips(session);
    ASSERT_EQ(clips.on.size(), 1U);
    EXPECT_NEAR(clips.on[0].rest_m.x(), 0.006, 0.0011) << "the layer of nodes that is next";
    EXPECT_GT(clips.on[0].opening_m, kMostSqueezed * 0.75 * kJawsSide_m);
    EXPECT_LT(clips.on[0].opening_m, kMostSqueezed * std::hypot(kJawsSide_m, kAside_m) + kRounding_m);
    EXPECT_GT(clips.on[0].force_n, 0);
    EXPECT_EQ(session.drain().stats.nonfinite, 0U);
    EXPECT_EQ(session.drain().health.trips, 0U);
  }
}

TEST_P(ClipSession, ThatClosesOnNothingIsSpentAndAMagazineEnds) {
  Scene scene = barScene();
  scene.styluses[0].clip.magazine = 2;
  Session session(scene, context_);
  clip(session, 0.006, 0.03);
  EXPECT_EQ(seenClips(session).empty, 1U);
  clip(session, 0.006);
  clip(session, -0.006);
  EXPECT_EQ(seenClips(session).on.size(), 1U);
  session.reset();
  EXPECT_EQ(seenClips(session).on.size() + seenClips(session).empty, 0U);
  clip(session, -0.006);
  EXPECT_EQ(seenClips(session).on.size(), 1U);
}

TEST_P(ClipSession, IsTakenOffByABladeThatMeetsItAndNotByOneBesideIt) {
  Scene still = barScene();
  still.bodies[0].material.mass_damping_per_s = kStill_per_s;
  Session session(still, context_);
  clip(session, 0.006);
  const auto draw = [&](double x_m) {
    session.step(at(x_m, false, false, 0.015), {});  // or the blade would cut all the way from the clip to there
    for (int t = 0; t <= kJawsClosing; ++t) session.step(at(x_m, false, true, 0.015 - 0.03 * t / kJawsClosing), {});
    for (int t = 0; t < kJawsOpen; ++t) session.step(at(x_m, false, false, -0.015), {});
    return seenClips(session);
  };
  EXPECT_EQ(seenClips(session).on.size(), 1U);
  EXPECT_EQ(draw(0.012).on.size(), 1U);
  for (int t = 0; t < kRests; ++t) session.step({}, {});
  StylusSamples along = at(0, false, true);  // along the bar, across the clip's legs
  for (int t = 0; t <= kJawsClosing; ++t) {
    along[0].pose.position_m = {0.012 - 0.016 * t / kJawsClosing, 0, -0.006};
    session.step(along, {});
  }
  const ClipStates after = seenClips(session);
  EXPECT_EQ(after.on.size(), 0U);
  EXPECT_EQ(after.taken_off, 1U);
}

TEST_P(ClipSession, GoesOnFromASavedStateToTheBit) {
  std::optional<Session> session(std::in_place, barScene(), context_);
  clip(*session, 0.006);
  Archive saved;
  session->save(saved);
  const auto onwards = [](Session& it) {
    clip(it, -0.006);
    it.drain();
    return it.stateHash();
  };
  const uint64_t expected = onwards(*session);
  session.reset();
  Session again(barScene(), context_);
  Archive read(saved.sections());
  again.restore(read, "a test");
  EXPECT_EQ(seenClips(again).on.size(), 1U);
  EXPECT_EQ(onwards(again), expected);
}

TEST_P(ClipSession, OfTwoBodiesJoinsThem) {
  Scene scene = barScene();
  scene.bodies[0].box_size_m.y() = 0.004;
  scene.bodies[0].position_m = {0, -0.0025, 0};
  scene.bodies.push_back(scene.bodies[0]);
  scene.bodies[1].name = "other";
  scene.bodies[1].position_m = {0, 0.0025, 0};
  scene.bodies[1].fixed.clear();
  Session session(scene, context_);
  clip(session, 0.006);
  const ClipStates clips = seenClips(session);
  ASSERT_EQ(clips.on.size(), 1U);
  EXPECT_LT(clips.on[0].opening_m, kMostSqueezed * 2 * kJawsSide_m);
}

TEST_P(ClipSession, IsDrawnAndKnownByItsLabel) {
  Scene scene = barScene();
  Session session(scene, context_);
  clip(session, 0.006);
  const ImageFrame labels = picture(session, PictureKind::kLabels);
  EXPECT_NE(std::find(labels.labels.begin(), labels.labels.end(), layout::kClipLabel), labels.labels.end());
}
VISCERA_ON_EVERY_BACKEND(ClipSession);

class GrasperSession : public ClipSession {
 protected:
  static Scene blockWithGrasper() {
    Scene scene = OnSceneBackend::scene();
    scene.bodies[0].material.young_modulus_pa = 50000;
    scene.styluses[0].button1 = ToolMode::kGrasper;
    scene.styluses[0].grasper.radius_m = 0.009;
    scene.styluses[0].grasper.jaw_length_m = kJaw_m;
    scene.styluses[0].grasper.opening_deg = 90;
    scene.styluses[0].grasper.max_force_n = kRated_n;
    return scene;
  }
  /// Returns a pull of 2.4 mm/s upwards, from the block's top.
  static StylusSamples pull(int tick) { return leftAt({0, 0, kHalfM + 4e-5 * tick}, tick > 1); }
  static double force_n(Session& session) {
    const layout::vec4 impulse = session.drain().stats.impulse[0];
    return Vector3d(impulse.x, impulse.y, impulse.z).norm() / session.tick_s();
  }
  /// Returns a bar, 8 mm wide between the jaws.
  static Scene barWithGrasper() {
    Scene scene = barScene();
    scene.styluses[0].button1 = ToolMode::kGrasper;
    scene.styluses[0].grasper = {0.009, 0.03, 60, kRated_n, 0.5};
    return scene;
  }
};

TEST_P(GrasperSession, HoldsAPullUpToItsFrictionAndTissueSlidesAtThatForceOutOfItsJaws) {
  Session session(blockWithGrasper(), context_);
  int slides_at = 0, lost_at = 0;
  double least_n = kRated_n, most_n = 0;
  for (int t = 1; t <= 700 && lost_at == 0; ++t) {
    session.step(pull(t), {});
    const double now_n = force_n(session);
    if (slides_at == 0 && now_n > kRated_n) slides_at = t;
    if (slides_at > 0 && session.drain().stats.grabbed[0] == 0) lost_at = t;
    if (slides_at == 0 || lost_at > 0) continue;
    least_n = std::min(least_n, now_n);
    most_n = std::max(most_n, now_n);
  }
  ASSERT_GT(slides_at, 0);
  ASSERT_GT(lost_at, 0) << "it slides out";
  EXPECT_GT(least_n, (1 - kSlips) * kRated_n);
  EXPECT_LT(most_n, (1 + kSlips) * kRated_n);
  EXPECT_NEAR(4e-5 * (lost_at - slides_at), kJaw_m, kLost_m);
  for (int t = lost_at; t < lost_at + 10; ++t) session.step(pull(t), {});
  EXPECT_EQ(force_n(session), 0) << "nothing is between the jaws any more";
}

TEST_P(GrasperSession, GoesOnSlidingFromASavedStateToTheBit) {
  std::optional<Session> session(std::in_place, blockWithGrasper(), context_);
  int t = 1;
  for (double now_n = 0; now_n <= kRated_n && t < 400; ++t) {
    session->step(pull(t), {});
    now_n = force_n(*session);
  }
  for (const int end = t + 20; t < end; ++t) session->step(pull(t), {});
  Archive saved;
  session->save(saved);
  const auto onwards = [t](Session& it) {
    for (int k = t; k < t + 20; ++k) it.step(pull(k), {});
    it.drain();
    return it.stateHash();
  };
  const uint64_t expected = onwards(*session);
  session.reset();
  Session again(blockWithGrasper(), context_);
  Archive read(saved.sections());
  again.restore(read, "a test");
  EXPECT_EQ(onwards(again), expected);
}

TEST_P(GrasperSession, IsKeptOpenByWhatIsBetweenItsFingersAndFeelsIt) {
  Session session(barWithGrasper(), context_);
  Frame frame;
  const auto close = [&](double y_m) {
    for (int t = 0; t < kJawsClosing; ++t) frame = session.step(at(0, t > 0, false, y_m), {});
    frame = session.drain();
    return session.motions()[0].opens_to_rad;
  };
  // The bar's sides, from its bottom to 3 mm below its top, as seen from the pivot 24 mm above its middle.
  const double low_rad = 2 * std::atan2(0.004, 0.028), high_rad = 2 * std::atan2(0.004, 0.021);
  const double held_rad = close(0);
  EXPECT_GT(held_rad, low_rad);
  EXPECT_LT(held_rad, high_rad);
  EXPECT_GT(frame.stats.grabbed[0], 0U);
  EXPECT_GT(frame.jaw_moments_nm[0], 0);
  session.step(at(0, false), {});
  EXPECT_EQ(close(0.03), 0) << "there is nothing";
  EXPECT_EQ(frame.stats.grabbed[0], 0U);
  EXPECT_EQ(frame.jaw_moments_nm[0], 0);
}

TEST_P(GrasperSession, HoldsAndLetsGoAsAUserClosesAndOpensIt) {
  Scene scene = barWithGrasper();
  scene.styluses[0].idle = ToolMode::kGrasper;
  Session session(scene, context_);
  const auto held = [&](double from_rad, double to_rad) {
    for (int t = 1; t <= kJawsClosing; ++t) {
      StylusSamples samples = at(0, false);
      samples[0].jaw_rad = static_cast<float>(from_rad + (to_rad - from_rad) * t / kJawsClosing);
      session.step(samples, {});
    }
    return session.drain().stats.grabbed[0];
  };
  EXPECT_EQ(held(1, 0.6), 0U) << "wider than the bar";
  EXPECT_GT(held(0.6, 0.2), 0U);
  EXPECT_GT(held(0.2, 0.2), 0U);
  EXPECT_EQ(held(0.2, 1), 0U);
}
VISCERA_ON_EVERY_BACKEND(GrasperSession);

}  // namespace
}  // namespace viscera
