// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// The scenes of GW's figures, run to rest: balls on a cloth, a cloth folded on the floor, the hanging flap of a cut. On
// the CPU, as a software rasteriser would take minutes; backends' contacts are compared elsewhere.
#include <gtest/gtest.h>

#include <algorithm>

#include "support/source_folder.h"
#include "viscera/session/session.h"
#include "viscera/tools/strokes.h"

namespace viscera {
namespace {

/// Root mean square of nodes' speeds. Single nodes of a cloth on round nodes tremble at 0.1 m/s; a fall of 1 cm gives
/// 0.44.
constexpr double kRests_m_per_s = 0.03;

Scene shipped(const std::string& name) {
  return loadScene(test::sourceFolder() + "/config/scenes/" + name + ".yaml");
}

/// A scene that is run, and the final positions of its nodes.
class Resting : public ::testing::Test {
 protected:
  void run(const Scene& scene, double seconds, const Strokes& strokes = {}) {
    session_ = std::make_unique<Session>(scene);
    const double tick_s = session_->tick_s();
    for (int t = 1; t * tick_s <= seconds; ++t) session_->step(strokes.at(t * tick_s, scene.styluses), {});
    state_ = session_->solver().readState();
  }
  const Model& model() const { return session_->model(); }
  Vector3d at(size_t body, uint32_t slot) const {
    const layout::vec4& u = state_.displacement_m[model().slotOffset(body) + slot];
    return restPosition(model().bodies[body], slot) + Vector3d(u.x, u.y, u.z);
  }
  const std::vector<uint32_t>& nodes(size_t body) const { return model().bodies[body].lattice.active_slots; }
  double speed(size_t body) const {
    double sum2 = 0;
    for (const uint32_t slot : nodes(body)) {
      const layout::vec4& v = state_.velocity_m_per_s[model().slotOffset(body) + slot];
      sum2 += Vector3d(v.x, v.y, v.z).squaredNorm();
    }
    return std::sqrt(sum2 / static_cast<double>(nodes(body).size()));
  }
  /// Returns the depth of a node below the surface [m]. Nodes outside have no tissue: only inner ones are measured.
  double depth(size_t body, uint32_t slot) const {
    const std::vector<float>& depths_m = model().bodies[body].lattice.depth_m;
    return depths_m.empty() ? 0 : depths_m[slot];
  }
  /// Returns the lowest height of a body's tissue [m].
  double lowest(size_t body) const {
    double out = 1e9;
    for (const uint32_t slot : nodes(body)) {
      if (depth(body, slot) >= 0) out = std::min(out, at(body, slot).z() - depth(body, slot));
    }
    return out;
  }
  /// Returns the smallest distance between the tissue of two bodies [m].
  double gap(size_t a, size_t b) const {
    double out = 1e9;
    for (const uint32_t i : nodes(a)) {
      for (const uint32_t j : nodes(b)) {
        const double deep = depth(a, i) + depth(b, j);
        if (std::min(depth(a, i), depth(b, j)) >= 0) out = std::min(out, (at(a, i) - at(b, j)).norm() - deep);
      }
    }
    return out;
  }
  std::unique_ptr<Session> session_;
  HostState state_;
};

TEST_F(Resting, BallsFallOntoTheClothTouchItAndLieInIt) {
  Scene scene = shipped("objects");
  scene.environment.wind = {};  // wind never lets them rest
  for (BodyConfig& body : scene.bodies) body.force_n.setZero();
  constexpr double kReach_m = 0.016 * 1.1;  // the cloth's spacing is its contact distance
  run(scene, 6);
  for (const size_t ball : {1u, 2u}) {
    EXPECT_LT(gap(ball, 0), kReach_m) << "ball " << ball << " hangs in the air";
    EXPECT_LT(speed(ball), kRests_m_per_s) << "ball " << ball;
    EXPECT_GT(lowest(ball), lowest(0)) << "ball " << ball << " is through the cloth";
  }
  EXPECT_LT(speed(0), kRests_m_per_s);
}

TEST_F(Resting, AClothOnEdgeFoldsOverItselfOnTheFloor) {
  constexpr double kFloor_m = -0.004, kSpacing_m = 0.0125, kApart = 5, kReach_m = 1.1 * kSpacing_m;
  run(shipped("cloth_self"), 5);
  size_t folded = 0;
  for (const uint32_t i : nodes(0)) {
    for (const uint32_t j : nodes(0)) {
      const double rest_m = (restPosition(model().bodies[0], i) - restPosition(model().bodies[0], j)).norm();
      folded += j > i && rest_m > kApart * kSpacing_m && (at(0, i) - at(0, j)).norm() < kReach_m;
    }
  }
  EXPECT_GT(folded, 20u) << "it does not lie on itself";
  EXPECT_NEAR(lowest(0), kFloor_m, 1e-3) << "it does not lie on the floor";
  EXPECT_LT(speed(0), kRests_m_per_s);
}

TEST_F(Resting, TheLipsOfACutClothHangApartAndRest) {
  const Scene scene = shipped("cloth_on_points");
  const Strokes strokes = loadStrokes(test::sourceFolder() + "/config/strokes/cut_cloth.yaml");
  run(scene, strokes.duration_s() + 4, strokes);
  // Nodes of the near edge on the two sides of the blade, adjacent before.
  double left = -1, right = 1;
  Vector3d left_at = Vector3d::Zero(), right_at = left_at;
  for (const uint32_t slot : nodes(0)) {
    const Vector3d rest = restPosition(model().bodies[0], slot);
    if (rest.y() > -0.24) continue;
    if (rest.x() < 0.05 && rest.x() > left) left = rest.x(), left_at = at(0, slot);
    if (rest.x() > 0.07 && rest.x() < right) right = rest.x(), right_at = at(0, slot);
  }
  EXPECT_GT((right_at - left_at).norm(), 2 * (right - left)) << "the lips do not part";
  EXPECT_LT(speed(0), kRests_m_per_s);
}

}  // namespace
}  // namespace viscera
