// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Hot tips, as seen by their user.
#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "math/archive.h"
#include "session/on_backends.h"
#include "viscera/math/error.h"
#include "viscera/session/tissue_processes.h"

namespace viscera {
namespace {

using namespace test;

constexpr double kTip_m = 0.004;          // radius of the hot tip, and of the probe next to it
constexpr double kCauteryBalance = 1e-9;  // of all heat, sums of float64
constexpr double kTime = 1e-6;            // of the heat of a number of ticks
constexpr double kAlike = 0.02;  // of heat and of forces, one backend against the other: positions differ by float32
constexpr double kStiffening = 1.2;   // factor over the fresh force at which a burn is felt
constexpr int kHeats = 20;            // ticks until tissue is warm
constexpr double kShrunk_m = 1.5e-4;  // least displacement of a free corner of coagulated tissue

class Cautery : public OnSceneBackend {
 protected:
  static Scene burning(double power_w, Structure structure = Structure::kLattice) {
    Scene out = scene();
    BodyConfig& body = out.bodies[0];
    body.structure = structure;
    body.source = structure == Structure::kSurface ? TissueSource::kSheet : TissueSource::kBox;
    body.box_size_m = {0.024, 0.024, 0.012};
    body.spacing_m = 0.003;
    body.fixed[0].point_m = {0, 0, -0.006};
    if (structure == Structure::kSurface) {
      body.fixed[0].point_m = {-0.011, 0, 0};
      body.fixed[0].normal = {1, 0, 0};
      body.fixed.push_back(body.fixed[0]);
      body.fixed[1].point_m = {0.011, 0, 0};
      body.fixed[1].normal = {-1, 0, 0};
    }
    for (StylusConfig& stylus : out.styluses) {
      stylus.idle = ToolMode::kNone;
      stylus.button1 = ToolMode::kCautery;
      stylus.button2 = ToolMode::kProbe;
      stylus.cautery = {kTip_m, power_w};
      stylus.probe.radius_m = kTip_m;
    }
    return out;
  }
  /// Returns a tip half a millimetre deep in the middle of the top.
  static StylusSamples on(bool hot, bool probes = false, double top_m = 0.006) {
    return leftAt({0, 0, top_m + kTip_m - 0.0005}, hot, probes);
  }
  static void burn(Session& session, int ticks, double top_m = 0.006) {
    session.step(leftAt({0, 0, 0.03}, true), {});
    for (int t = 0; t < ticks; ++t) session.step(on(true, false, top_m), {});
  }
  /// Returns the additional force on a probe half a cell below the surface in the middle, compared to `top_m`.
  static double pressed_n(Session& session, double top_m) {
    double force_n[2];
    session.step(leftAt({0, 0, 0.03}, false, true), {});
    for (int i = 0; i < 2; ++i) {
      Frame frame;
      for (int t = 0; t < 60; ++t) frame = session.step(leftAt({0, 0, top_m + kTip_m - 0.0015 * i}, false, true), {});
      force_n[i] = frame.reactions[0].force_n.z();
    }
    return force_n[1] - force_n[0];
  }
  /// Returns the height of the surface in the middle.
  static double top_m(Session& session) {
    FrameRequest outputs;
    outputs.surface = true;
    const Pictures pictures = session.show(outputs);
    double out = -1;
    for (size_t v = 0; v < pictures.surface->vertices(); ++v) {
      const Vector3f at = pictures.surface->position_m(v);
      if (at.head<2>().norm() < 0.001F) out = std::max(out, static_cast<double>(at.z()));
    }
    return out;
  }
};

TEST_P(Cautery, HeatIsPowerTimesTimeInTouchAndAllOfItIsAccountedFor) {
  for (const Structure structure : {Structure::kLattice, Structure::kExplicit, Structure::kSurface}) {
    SCOPED_TRACE(static_cast<int>(structure));
    Session session(burning(4, structure), context_);
    const double top_m = structure == Structure::kSurface ? 0 : 0.006;
    for (int t = 0; t < 3; ++t) session.step(leftAt({0, 0, 0.03}, true), {});
    EXPECT_EQ(seenBurns(session).given_j, 0) << "nothing is touched";
    burn(session, kHeats, top_m);
    const BurnReport seen = seenBurns(session);
    EXPECT_NEAR(seen.given_j, kHeats * 4 * session.tick_s(), kTime * seen.given_j);
    EXPECT_NEAR(seen.stored_j + seen.steam_j + seen.perfused_j + seen.surface_j, seen.given_j,
                kCauteryBalance * seen.given_j);
    EXPECT_GT(seen.hottest_c, 45);
    for (int t = 0; t < 5; ++t) session.step(on(false, false, top_m), {});
    EXPECT_EQ(seenBurns(session).given_j, seen.given_j) << "not pressed";
    EXPECT_LT(seenBurns(session).hottest_c, seen.hottest_c);
    session.step(on(true, false, top_m), {});
    EXPECT_NEAR(seenBurns(session).given_j, (kHeats + 1) * 4 * session.tick_s(), kTime * seen.given_j)
        << "also where it was in tissue before, and pushes nothing";
    EXPECT_EQ(session.drain().stats.nonfinite, 0U);
    EXPECT_EQ(session.drain().health.trips, 0U);
  }
}

/// From above: the borders of the spot are as far away along the lattice as across it.
TEST_P(Cautery, ABurnIsARoundSpotThatIsBrownWithin) {
  constexpr double kOutOfRound = 0.3;  // of the mean radius: irregular borders of 0.3 mm, and pixels
  Scene seen = burning(15);
  CameraConfig& camera = seen.cameras[0];
  camera.position_m = Vector3d(0, -0.0005, 0.08);
  camera.width_px = camera.height_px = 160;
  camera.vertical_fov_deg = 17;
  Session session(seen, context_);
  const ImageFrame fresh = picture(session);
  burn(session, 120);
  for (int t = 0; t < 10; ++t) session.step({}, {});
  const ImageFrame burnt = picture(session);
  constexpr double kLeast = 40;  // of 3 * 255, summed over the colours
  double radii_px[8];
  for (int d = 0; d < 8; ++d) {
    const double angle = d * M_PI / 4;
    radii_px[d] = 0;
    for (int r = 0; r < 78; ++r) {
      const int column = 80 + static_cast<int>(std::lround(r * std::cos(angle)));
      const int row = 80 + static_cast<int>(std::lround(r * std::sin(angle)));
      const auto i = static_cast<size_t>(3 * (row * 160 + column));
      int differs = 0;
      for (size_t c = 0; c < 3; ++c) differs += std::abs(burnt.rgb[i + c] - fresh.rgb[i + c]);
      if (differs > kLeast) radii_px[d] = r;
    }
  }
  double mean = 0;
  for (const double radius : radii_px) mean += radius / 8;
  EXPECT_GT(mean, 10);
  for (int d = 0; d < 8; ++d) EXPECT_NEAR(radii_px[d], mean, kOutOfRound * mean) << 45 * d << " degrees";
  const auto middle = static_cast<size_t>(3 * (80 * 160 + 80));
  EXPECT_LT(burnt.rgb[middle], fresh.rgb[middle]) << "browned";
}

TEST_P(Cautery, CoagulatedTissueIsStifferToAProbeAndDrawnIn) {
  Session session(burning(3), context_);
  const double fresh_n = pressed_n(session, top_m(session));
  burn(session, 360);
  EXPECT_GT(seenBurns(session).coagulated_m3, 5e-8) << "50 mm3";
  EXPECT_EQ(seenBurns(session).parted, 0U);
  for (int t = 0; t < 60; ++t) session.step({}, {});
  const double dent_m = top_m(session);
  EXPECT_LT(dent_m, 0.006 - kShrunk_m);
  const double burnt_n = pressed_n(session, dent_m);
  EXPECT_GT(burnt_n, kStiffening * fresh_n);
}

TEST_P(Cautery, DriedTissuePartsAndIsDrawnBurnt) {
  Session session(burning(240), context_);
  const ImageFrame before = picture(session);
  burn(session, 8);
  const ImageFrame during = picture(session);
  EXPECT_NE(before.rgb, during.rgb);
  burn(session, 60);
  const BurnReport seen = seenBurns(session);
  EXPECT_GT(seen.parted, 0U);
  EXPECT_GT(seen.steam_j, 0);
  EXPECT_GT(session.drain().stats.springs_cut, 0U);
  EXPECT_EQ(session.drain().stats.nonfinite, 0U);
}

TEST_P(Cautery, SurfacesHaveTheColoursOfBurnsAndOfStrainWhereThereAreSome) {
  Session session(burning(24), context_);
  FrameRequest outputs;
  outputs.surface = true;
  session.step({}, {});
  const Pictures plain = session.show(outputs);
  EXPECT_TRUE(plain.surface->colors.empty());
  EXPECT_TRUE(plain.surface->strain_colors.empty());
  burn(session, 45);
  outputs.strain = true;
  const Pictures seen = session.show(outputs);
  const SurfaceFrame& surface = *seen.surface;
  ASSERT_EQ(surface.colors.size(), surface.vertices());
  ASSERT_EQ(surface.strain_colors.size(), surface.vertices());
  std::set<uint32_t> near, far, strained;
  for (size_t v = 0; v < surface.vertices(); ++v) {
    EXPECT_EQ(surface.colors[v] >> 24U, 255U);
    EXPECT_EQ(surface.strain_colors[v] >> 24U, 255U);
    const double off_m = surface.position_m(v).head<2>().norm();
    if (off_m < 0.001 && surface.position_m(v).z() > 0) near.insert(surface.colors[v]);
    if (off_m > 0.0125) far.insert(surface.colors[v]);
    strained.insert(surface.strain_colors[v]);
  }
  EXPECT_EQ(far.size(), 1U) << "as it came";
  ASSERT_FALSE(near.empty());
  EXPECT_EQ(near.count(*far.begin()), 0U);
  EXPECT_GT(strained.size(), 10U);
}

TEST_P(Cautery, SavedStatesAndResetsHaveBurns) {
  const Scene scene = burning(60);
  Archive saved;
  uint64_t hash = 0;
  BurnReport seen;
  {
    Session session(scene, context_);
    const uint64_t whole = session.stateHash();
    burn(session, kHeats);
    session.save(saved);
    for (int t = 0; t < kHeats; ++t) session.step(on(true), {});
    hash = session.stateHash();
    seen = seenBurns(session);
    session.reset();
    EXPECT_EQ(seenBurns(session).given_j, 0);
    EXPECT_EQ(session.stateHash(), whole);
  }
  Session other(scene, context_);
  Archive kept(saved.take());
  other.restore(kept, "a test");
  for (int t = 0; t < kHeats; ++t) other.step(on(true), {});
  EXPECT_EQ(other.stateHash(), hash);
  EXPECT_EQ(seenBurns(other).given_j, seen.given_j);
  EXPECT_EQ(seenBurns(other).parted, seen.parted);
}

VISCERA_ON_EVERY_BACKEND(Cautery);

TEST_F(GpuTest, CauteryIsTheSameOnBothBackends) {
  double force_n[2];
  BurnReport seen[2];
  for (const Backend backend : {Backend::kCpu, Backend::kGpu}) {
    Scene scene = blockScene();
    scene.solver.backend = backend;
    scene.styluses[0].button1 = ToolMode::kCautery;
    scene.styluses[0].cautery = {0.008, 20};
    Session session(scene, context_);
    const size_t i = backend == Backend::kGpu;
    for (int t = 0; t < 90; ++t) {
      const Frame frame = session.step(leftAt({0, 0, 0.03 - 0.004 * std::min(1.0, t / 30.0)}, true), {});
      force_n[i] = frame.reactions[0].force_n.z();
    }
    session.drain();
    seen[i] = seenBurns(session);
  }
  EXPECT_GT(seen[0].given_j, 1);
  EXPECT_NEAR(seen[1].given_j, seen[0].given_j, kAlike * seen[0].given_j);
  EXPECT_NEAR(seen[1].hottest_c, seen[0].hottest_c, kAlike * seen[0].hottest_c);
  EXPECT_GT(force_n[0], 0);
  EXPECT_NEAR(force_n[1], force_n[0], kAlike * force_n[0]);
}

TEST_F(GpuTest, ScenesWithoutCauteryRefuseItAndIntegratorsThatCannotAreNamed) {
  Session session(blockScene(), context_);
  EXPECT_THROW(session.setToolMode(0, ToolSwitch::kButton1, ToolMode::kCautery), SceneError);
  EXPECT_EQ(seenBurns(session).given_j, 0);
  try {
    parseScene("bodies: [{source: box}]\nstyluses: [{button1: cautery}]\nsolver: {integrator: pd}", "pd.yaml");
    FAIL() << "pd is taken";
  } catch (const SceneError& error) {
    EXPECT_NE(std::string(error.what()).find("mode cautery needs solver.integrator leapfrog, not pd"),
              std::string::npos)
        << error.what();
  }
  EXPECT_THROW(parseScene("bodies: [{source: box}]\nstyluses: [{cautery: {power_w: 401}}]", "w.yaml"), SceneError);
}

}  // namespace
}  // namespace viscera
