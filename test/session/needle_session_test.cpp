// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// A scene and a strokes file as users write them: a stylus takes a needle, drives it through and releases it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "viscera/math/error.h"
#include "viscera/session/session.h"
#include "viscera/session/tissue_processes.h"
#include "viscera/tools/strokes.h"

namespace viscera {
namespace {

constexpr const char* kScene = R"(
bodies:
  - {source: box, box_size_m: [0.03, 0.018, 0.012], position_m: [0, 0, -0.006], spacing_m: 0.003, material: {young_modulus_pa: 10000},
     fixed: [{min_m: [-1, -1, -1], max_m: [1, 1, -0.0059]}]}
styluses: [{name: holder, idle: none, button1: needle, button2: none, grab: {radius_m: 0.01}}]
sutures:
  - {material: silk, usp: 4-0, position_m: [0.008, 0, 0.003], path: [{position_m: [0.008, 0, 0.09]}],
     needle: {arc: half_circle, radius_m: 0.008, rotation_deg: [0, 180, 0]}}
solver: {backend: cpu, threads: 1}
)";

/// Turns the holder about the centre of the needle's circle, by 252 degrees in a second.
constexpr const char* kStrokes = R"(
strokes:
  - stylus: holder
    keys:
      - {t_s: 0, position_m: [0, 0, 0.003], rotation_deg: [0, 0, 0], button1: true}
      - {t_s: 0.1, position_m: [0, 0, 0.003], rotation_deg: [0, 0, 0], button1: true}
      - {t_s: 0.43, position_m: [0, 0, 0.003], rotation_deg: [0, -84, 0], button1: true}
      - {t_s: 0.76, position_m: [0, 0, 0.003], rotation_deg: [180, -12, 180], button1: true}
      - {t_s: 1.1, position_m: [0, 0, 0.003], rotation_deg: [180, 72, 180], button1: true}
      - {t_s: 1.3, position_m: [0, 0, 0.003], rotation_deg: [180, 72, 180], button1: false}
      - {t_s: 1.5, position_m: [0, 0, 0.05], rotation_deg: [180, 72, 180]}
)";

constexpr double kLeastForce_n = 1e-3;
/// E of the scene times its spacing; and with the whole needle in tissue.
constexpr double kSkin_n_per_m = 1e4 * 0.003, kWhole_m = 3.1416 * 0.008, kWhole_n_per_m = 1e4 * (0.003 + kWhole_m);
constexpr double kPuncture_n = 0.05, kFriction_n_per_m = 1;  ///< of docs/sutures.md

struct Sewn {
  double most_n = 0, off_m = 0, moved_m = 0;  ///< the suture's start from the tail; motion after the release
  Vector3d tip = Vector3d::Zero();
  uint64_t hash = 0, trips = 0;
  int unfelt = 0;                   ///< ticks with a force that the haptic model between ticks does not have
  double skin_n = 0, inside_n = 0;  ///< widest reported range of force along, at the surface and inside
  double skin_n_per_m = 0, inside_n_per_m = 0;  ///< largest reported stiffness of the tissue around it
  double unseen_m = 0;                          ///< distance of tip and tail from their positions in needleStates()
  bool in_tissue = false;                       ///< as reported there
  std::vector<size_t> holders = {};             ///< in order, kMaxStyluses for none
};

Sewn sew(const Overrides& overrides) {
  const Scene scene = parseScene(kScene, "needle.yaml", overrides);
  const Strokes strokes = parseStrokes(kStrokes, "strokes.yaml");
  Session session(scene);
  Sewn out;
  Vector3d left = Vector3d::Zero();
  for (double time_s = 0; time_s < 1.8; time_s += session.tick_s()) {
    const Frame frame = session.step(strokes.at(time_s, scene.styluses), {});
    const std::vector<Vector3d> needle = needlePositions(session, 0);
    out.most_n = std::max(out.most_n, frame.reactions[0].force_n.norm());
    const layout::vec4& given = frame.stats.impulse[0];
    const bool pressed = Vector3d(given.x, given.y, given.z).norm() > kLeastForce_n * session.tick_s();
    const TickContact& contact = frame.contacts[0];
    out.unfelt += pressed && contact.kind == TickContact::Kind::kFree;
    if (contact.kind == TickContact::Kind::kPierces) {
      const bool inside = contact.stiffness_n_per_m > 1.01 * kSkin_n_per_m;
      double& most_n = inside ? out.inside_n : out.skin_n;
      double& most_n_per_m = inside ? out.inside_n_per_m : out.skin_n_per_m;
      most_n = std::max(most_n, contact.limit_n + contact.back_n);
      most_n_per_m = std::max(most_n_per_m, contact.stiffness_n_per_m);
    }
    out.off_m = std::max(out.off_m, (suturePositions(session, 0)[0] - needle.back()).norm());
    if (frame.needles.size() == 1) {
      const NeedleState& seen = frame.needles[0];
      const Vector3d tip = seen.pose * Vector3d(seen.radius_m, 0, 0);
      const double arc_rad = seen.arc_rad;
      const Vector3d tail =
          seen.pose * Vector3d(seen.radius_m * std::cos(arc_rad), 0, -seen.radius_m * std::sin(arc_rad));
      out.unseen_m = std::max({out.unseen_m, (tip - needle.front()).norm(), (tail - needle.back()).norm()});
      if (out.holders.empty() || out.holders.back() != seen.stylus) out.holders.push_back(seen.stylus);
      out.in_tissue = out.in_tissue || seen.in_tissue;
    } else {
      out.unseen_m = 1;
    }
    out.tip = needle.front();
    if (time_s < 1.3) left = needle.front();
    out.trips = frame.health.trips;
  }
  out.moved_m = (out.tip - left).norm();
  out.hash = session.stateHash();
  return out;
}

TEST(NeedleSession, AStylusTakesOneDrivesItThroughAndLetsItGo) {
  const Sewn once = sew({});
  EXPECT_GT(once.most_n, 0.04);
  EXPECT_LT(once.most_n, 0.5);
  EXPECT_LT(once.off_m, 1e-4);
  EXPECT_EQ(once.unfelt, 0);  // also at the surface, before it is in
  EXPECT_LT(once.unseen_m, 1e-9);
  EXPECT_TRUE(once.in_tissue);
  EXPECT_EQ(std::count(once.holders.begin(), once.holders.end(), 0U), 1) << "taken once";
  EXPECT_EQ(once.holders.back(), layout::kMaxStyluses) << "let go";
  EXPECT_NEAR(once.skin_n, kPuncture_n, 1e-3 * kPuncture_n);
  EXPECT_GT(once.inside_n, kPuncture_n);  // the far surface, and friction both ways
  EXPECT_LT(once.inside_n, kPuncture_n + 2 * kFriction_n_per_m * kWhole_m);
  EXPECT_NEAR(once.skin_n_per_m, kSkin_n_per_m, 0.01 * kSkin_n_per_m);
  EXPECT_GT(once.inside_n_per_m, 2 * kSkin_n_per_m);
  EXPECT_LT(once.inside_n_per_m, kWhole_n_per_m);
  EXPECT_GT(once.tip.x(), 0);  // where it came out, not where it went in
  EXPECT_LT(once.moved_m, 0.01);
  EXPECT_EQ(once.trips, 0u);
  EXPECT_EQ(sew({}).hash, once.hash);
  EXPECT_EQ(sew({"solver.threads=4"}).hash, once.hash);
}

std::string refusal(const Overrides& overrides) {
  try {
    parseScene(kScene, "needle.yaml", overrides);
  } catch (const SceneError& error) {
    return error.what();
  }
  return {};
}

TEST(NeedleSession, ScenesThatCannotBeAreRefused) {
  const auto names = [](const std::string& text, const std::string& what) { return text.find(what) != text.npos; };
  EXPECT_TRUE(refusal({}).empty());
  EXPECT_TRUE(names(refusal({"sutures[0].needle.arc=none"}), "stylus 'holder' has mode needle"));
  EXPECT_TRUE(names(refusal({"sutures[0].needle.arc=quarter"}), "half_circle"));
  EXPECT_TRUE(names(refusal({"sutures[0].start=fixed"}), "'start' must be free"));
  EXPECT_TRUE(names(refusal({"sutures[0].needle.wire_radius_m=0.002"}), "'needle.wire_radius_m' must be at most 0.2"));
  EXPECT_TRUE(names(refusal({"sutures[0].needle.puncture_n=0.1", "sutures[0].needle.cutting_n=0.2"}),
                    "'needle.cutting_n' must be at most"));
}

}  // namespace
}  // namespace viscera
