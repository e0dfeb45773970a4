// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Vessels that are cut, clipped and burnt, as seen by the user of the tools.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "math/archive.h"
#include "session/on_backends.h"
#include "solver/processes/bleed/bleeding.h"
#include "surface/skins/part_colors.h"
#include "viscera/math/error.h"
#include "viscera/session/tissue_processes.h"

namespace viscera {
namespace {

using namespace test;

constexpr double kSide_m = 0.008;  // of the vessel
constexpr double kFlow = 60;       // ml/min, out of a stump
constexpr double kBalance = 1e-9;  // of all blood, sums of float64
constexpr double kFull = 1e-9;     // of the flow out of a full cut: its area is at least that of the vessel
constexpr double kNick = 0.02;     // of the flow out of a nick: lengths of vessels are from corner to corner
constexpr int kClosing = 20, kOpen = 4, kDraws = 15;  // ticks
constexpr Structure kStructures[] = {Structure::kLattice, Structure::kExplicit, Structure::kSurface};

class Bleeding : public OnSceneBackend {
 protected:
  /// Returns a vessel that hangs from its end at -x, the source of its blood. It is so light that a cut piece falls by
  /// 0.3 m in the 2.5 s of a test.
  static Scene vessel(Structure structure = Structure::kLattice) {
    Scene out = scene();
    out.environment.gravity_m_per_s2 = {0.1, 0, 0};
    BodyConfig& body = out.bodies[0];
    body.source = structure == Structure::kSurface ? TissueSource::kSheet : TissueSource::kBox;
    body.structure = structure;
    body.box_size_m = {0.04, kSide_m, structure == Structure::kSurface ? 0 : kSide_m};
    body.spacing_m = 0.002;
    body.material.bleeding.flow_ml_per_min = kFlow;
    body.fixed[0].point_m = {-0.017, 0, 0};
    body.fixed[0].normal = {1, 0, 0};
    StylusConfig& left = out.styluses[0];
    left.idle = ToolMode::kNone;
    left.button1 = ToolMode::kClip;
    left.button2 = ToolMode::kCut;
    left.cut.blade_length_m = 0.03;
    out.styluses[1].idle = ToolMode::kNone;
    return out;
  }
  /// Returns a tool from above across the vessel, its tips beyond it.
  static StylusSamples at(const Vector3d& tip_m, bool closes, bool cuts = false) {
    StylusSamples out{};
    out[0].valid = true;
    out[0].pose.position_m = tip_m;
    out[0].pose.orientation = Quaterniond(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitZ()));
    out[0].button1 = closes;
    out[0].button2 = cuts;
    return out;
  }
  static void rest(Session& session, int ticks) {
    for (int t = 0; t < ticks; ++t) session.step({}, {});
  }
  /// Cuts with the blade from its tip upwards, across the vessel.
  static void cutAt(Session& session, double x_m, double tip_z_m = -0.012) {
    for (int t = 0; t <= kDraws; ++t) session.step(at({x_m, 0.015 - 0.03 * t / kDraws, tip_z_m}, false, true), {});
    rest(session, kOpen);
  }
  static void clipAt(Session& session, double x_m) {
    for (int t = 0; t < kOpen; ++t) session.step(at({x_m, 0, -0.006}, false), {});
    for (int t = 0; t < kClosing; ++t) session.step(at({x_m, 0, -0.006}, true), {});
    rest(session, kOpen);
  }
};

TEST_P(Bleeding, OutOfAStumpIsWhatTheKeySaysAndAllOfItIsSomewhere) {
  for (const Structure structure : kStructures) {
    SCOPED_TRACE(static_cast<int>(structure));
    Session session(vessel(structure), context_);
    rest(session, 3);
    EXPECT_EQ(seenBlood(session).bled_ml, 0) << "nothing is cut";
    cutAt(session, 0.0051);
    const BloodReport first = seenBlood(session);
    EXPECT_NEAR(first.flow_ml_per_min, kFlow, kFull * kFlow);
    EXPECT_EQ(first.stumps, 1U) << "the other one is not held: nothing feeds it";
    constexpr int kTicks = 60;
    rest(session, kTicks);
    const BloodReport seen = seenBlood(session);
    EXPECT_NEAR(seen.bled_ml - first.bled_ml, kFlow / 60 * kTicks * session.tick_s(), kBalance * seen.bled_ml);
    EXPECT_NEAR(seen.on_tissue_ml + seen.dripped_ml, seen.bled_ml, kBalance * seen.bled_ml);
    EXPECT_GT(seen.dripped_ml, 0);
    session.reset();
    EXPECT_EQ(seenBlood(session).bled_ml, 0);
  }
}

/// The surfaces sent to rviz and exported are coloured as images are.
TEST_P(Bleeding, SurfacesHaveTheColourOfBlood) {
  Session session(vessel(), context_);
  FrameRequest outputs;
  outputs.surface = true;
  rest(session, 3);
  EXPECT_TRUE(session.show(outputs).surface->colors.empty());
  cutAt(session, 0.0051);
  rest(session, 30);
  const Pictures seen = session.show(outputs);
  ASSERT_EQ(seen.surface->colors.size(), seen.surface->vertices());
  std::set<uint32_t> beside_the_cut, at_the_far_end;
  for (size_t v = 0; v < seen.surface->vertices(); ++v) {
    const float x_m = seen.surface->position_m(v).x();
    if (std::abs(x_m - 0.0051F) < 0.001F) beside_the_cut.insert(seen.surface->colors[v]);
    if (x_m < -0.019F) at_the_far_end.insert(seen.surface->colors[v]);
  }
  ASSERT_EQ(at_the_far_end.size(), 1U) << "as it came";
  ASSERT_FALSE(beside_the_cut.empty());
  EXPECT_EQ(beside_the_cut.count(*at_the_far_end.begin()), 0U);
}

TEST(FluidColor, OfBileIsYellowGreenAndThatOfBloodRed) {
  constexpr uint32_t kGrey = 0xff808080U;
  const auto channel = [](uint32_t rgba, int c) { return static_cast<int>(rgba >> (8 * c) & 255); };
  const uint32_t bile = paintedColor(PaintKind::kBile, kGrey, 1), blood = paintedColor(PaintKind::kBlood, kGrey, 1);
  EXPECT_GT(channel(bile, 1), 3 * channel(bile, 2));
  EXPECT_NEAR(channel(bile, 0), channel(bile, 1), 10);
  EXPECT_GT(channel(blood, 0), 5 * channel(blood, 1));
}

TEST_P(Bleeding, OutOfANickIsItsShareOfTheCrossSectionOnEitherSide) {
  Session session(vessel(), context_);
  cutAt(session, 0.0051, 0.0031);  // an eighth of it: of five layers of nodes, half a spacing of the uppermost
  EXPECT_NEAR(seenBlood(session).flow_ml_per_min, 2 * kFlow / 8, kNick * kFlow);
}

TEST_P(Bleeding, StopsByAClipBetweenTheHeldEndAndTheCutAndGoesOnWithoutIt) {
  for (const Structure structure : kStructures) {
    SCOPED_TRACE(static_cast<int>(structure));
    Session session(vessel(structure), context_);
    clipAt(session, 0.012);
    cutAt(session, 0.0051);
    EXPECT_NEAR(seenBlood(session).flow_ml_per_min, kFlow, kFull * kFlow) << "a clip beyond the cut";
    clipAt(session, -0.006);
    ASSERT_EQ(seenClips(session).on.size(), 2U);
    const BloodReport stopped = seenBlood(session);
    EXPECT_EQ(stopped.flow_ml_per_min, 0);
    EXPECT_EQ(stopped.stumps, 0U);
    rest(session, 10);
    EXPECT_EQ(seenBlood(session).bled_ml, stopped.bled_ml);
    // Along the vessel, across the clip's legs, and back on its other side: when cut, it swings by a clip's half width.
    for (const double aside_m : {0.001, -0.001}) {
      for (int t = 0; t <= kDraws; ++t)
        session.step(at({-0.012 * (aside_m > 0 ? t : kDraws - t) / kDraws, aside_m, -0.006}, false, true), {});
    }
    rest(session, kOpen);
    ASSERT_EQ(seenClips(session).taken_off, 1U);
    EXPECT_NEAR(seenBlood(session).flow_ml_per_min, kFlow, kFull * kFlow);
  }
}

TEST_P(Bleeding, StopsWhereTheStumpIsBurnt) {
  Scene scene = vessel();
  scene.styluses[1].button1 = ToolMode::kCautery;
  scene.styluses[1].cautery = {0.004, 24};
  scene.bodies[0].box_size_m = {0.04, 0.004, 0.004};
  Session session(scene, context_);
  cutAt(session, 0.0051);
  ASSERT_GT(seenBlood(session).flow_ml_per_min, 0);
  StylusSamples hot{};
  hot[1] = {true, {{0.0072, 0, 0}, Quaterniond::Identity()}, true, false};
  constexpr int kMostTicks = 900;
  int ticks = 0;
  for (; ticks < kMostTicks && seenBlood(session).flow_ml_per_min > 0; ++ticks) session.step(hot, {});
  EXPECT_GT(ticks, 7) << "16 mm2 are not coagulated in a tenth of a second by 24 W";
  EXPECT_EQ(seenBlood(session).flow_ml_per_min, 0);
  EXPECT_GT(seenBurns(session).coagulated_m3, 0);
}

/// Out of an elastic bag: V (1 - exp(-Q t / V)).
TEST_P(Bleeding, OfBileFallsAsItsVolumeRunsOut) {
  constexpr double kVolume_ml = 0.8;
  Scene scene = vessel();
  scene.bodies[0].material.bleeding.fluid = Fluid::kBile;
  scene.bodies[0].material.bleeding.volume_ml = kVolume_ml;
  Session session(scene, context_);
  cutAt(session, 0.0051);
  const BloodReport first = seenBile(session);
  EXPECT_NEAR(first.flow_ml_per_min, kFlow * (1 - first.bled_ml / kVolume_ml), kFull * kFlow);
  constexpr int kTicks = 60;
  rest(session, kTicks);
  const BloodReport seen = seenBile(session);
  const double decay = std::exp(-kFlow / 60 * kTicks * session.tick_s() / kVolume_ml);
  EXPECT_NEAR(kVolume_ml - seen.bled_ml, (kVolume_ml - first.bled_ml) * decay, kBalance * kVolume_ml);
  EXPECT_LT(decay, 0.5);
  EXPECT_EQ(seenBlood(session).bled_ml, 0);
  session.reset();
  EXPECT_EQ(seenBile(session).bled_ml, 0);
  cutAt(session, 0.0051);
  EXPECT_EQ(seenBile(session).bled_ml, first.bled_ml) << "full again";
}

TEST_P(Bleeding, IsTakenAwayBySuctionWithinItsReach) {
  Scene scene = vessel();
  scene.styluses[1].button1 = ToolMode::kSuction;
  scene.styluses[1].suction.radius_m = 0.006;
  Session session(scene, context_);
  cutAt(session, 0.0051);
  rest(session, 20);
  EXPECT_EQ(seenBlood(session).suctioned_ml, 0);
  const auto hold = [&](const Vector3d& at_m, bool sucks) {
    StylusSamples cup{};
    cup[1] = {true, {at_m, Quaterniond::Identity()}, sucks, false};
    for (int t = 0; t < 15; ++t) session.step(cup, {});
  };
  hold({0.004, 0, 0.004}, false);
  hold({0.004, 0, 0.05}, false);  // suction holds tissue: it must begin away from it
  hold({0.004, 0, 0.05}, true);
  EXPECT_EQ(seenBlood(session).suctioned_ml, 0) << "not sucking, then out of reach";
  hold({0.004, 0, 0.004}, true);
  const BloodReport seen = seenBlood(session);
  EXPECT_GT(seen.suctioned_ml, 0.01);
  EXPECT_NEAR(seen.on_tissue_ml + seen.dripped_ml + seen.suctioned_ml, seen.bled_ml, kBalance * seen.bled_ml);
}

TEST_P(Bleeding, PushesNothingAndIsSeen) {
  struct Appearance {
    uint64_t tissue = 0;
    std::vector<uint8_t> whole, cut, clean;
  } variants[2];
  for (Appearance& of : variants) {
    Scene scene = vessel();
    if (&of == variants) scene.bodies[0].material.bleeding = {};
    Session session(scene, context_);
    EXPECT_EQ(findProcess<viscera::Bleeding>(session.solver()) == nullptr, &of == variants);
    of.whole = picture(session).rgb;
    cutAt(session, 0.0051);
    rest(session, 30);
    EXPECT_EQ(seenBlood(session).bled_ml == 0, &of == variants);
    of.cut = picture(session).rgb;
    of.tissue = stateHash(session.model(), session.solver().readState());
    session.reset();
    of.clean = picture(session).rgb;
  }
  EXPECT_EQ(variants[0].tissue, variants[1].tissue);
  EXPECT_EQ(variants[0].whole, variants[1].whole);
  EXPECT_NE(variants[0].cut, variants[1].cut);
  EXPECT_EQ(variants[0].clean, variants[1].clean);
}

TEST_P(Bleeding, GoesOnFromASavedStateToTheBit) {
  const auto onwards = [](Session& it) {
    rest(it, 15);
    clipAt(it, -0.006);
    it.drain();
    return std::make_pair(it.stateHash(), seenBlood(it).bled_ml);
  };
  Archive saved;
  std::pair<uint64_t, double> expected;
  {
    Session session(vessel(), context_);
    const uint64_t whole = session.stateHash();
    cutAt(session, 0.0051);
    session.save(saved);
    expected = onwards(session);
    EXPECT_GT(expected.second, 0);
    session.reset();
    EXPECT_EQ(session.stateHash(), whole);
    EXPECT_EQ(seenBlood(session).bled_ml, 0);
  }
  Session again(vessel(), context_);
  Archive read(saved.sections());
  again.restore(read, "a test");
  EXPECT_EQ(onwards(again), expected);
  EXPECT_EQ(seenBlood(again).flow_ml_per_min, 0);
}

VISCERA_ON_EVERY_BACKEND(Bleeding);

TEST(BleedingKeys, OfPartsAreThoseOfTheMaterialUnlessTheySayOtherwiseAndRangesAreNamed) {
  const Scene scene = parseScene(
      "bodies: [{source: phantom, material: {bleeding: {flow_ml_per_min: 30, calibre_m: 0.004}}, "
      "parts: [{part: septum, bleeding: {flow_ml_per_min: 90}}]}]",
      "vessels.yaml");
  EXPECT_EQ(scene.bodies[0].parts.at(0).bleeding.flow_ml_per_min, 90);
  EXPECT_EQ(scene.bodies[0].parts.at(0).bleeding.calibre_m, 0.004);
  try {
    parseScene("bodies: [{source: box, material: {bleeding: {flow_ml_per_min: -1}}}]", "vessels.yaml");
    FAIL() << "blood that runs in is taken";
  } catch (const SceneError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("vessels.yaml"), std::string::npos) << text;
    EXPECT_NE(text.find("bleeding.flow_ml_per_min"), std::string::npos) << text;
    EXPECT_NE(text.find("0 .. 10000"), std::string::npos) << text;
  }
  try {
    parseScene("bodies: [{source: box, material: {bleeding: {fluid: water}}}]", "vessels.yaml");
    FAIL() << "water is taken";
  } catch (const SceneError& error) {
    EXPECT_NE(std::string(error.what()).find("bleeding.fluid"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("bile, blood"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace viscera
