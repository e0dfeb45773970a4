// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/contact/collision.h"
#include "support/backends.h"
#include "support/loose_cloth.h"
#include "support/momentum.h"
#include "support/random_state.h"

using namespace viscera;
using namespace viscera::test;

namespace {

constexpr double kSpacing_m = 0.01;
constexpr double kGravity_m_per_s2 = 9.81;

Scene collidingScene(const Model& model) {
  Scene scene = sceneFor(model, 1);
  scene.collision.enabled = true;
  return scene;
}

class Collide : public OnBackend {};
INSTANTIATE_TEST_SUITE_P(Backends, Collide, ::testing::ValuesIn(backendKinds()), backendSuffix);

Pose at(double x, double y, double z) {
  return {Vector3d(x, y, z), Quaterniond::Identity()};
}

/// Passages of nodes of one body through the triangles of another.
class Passages {
 public:
  Passages(const Model& model, size_t nodes, size_t triangles) : model_(model), nodes_(nodes), triangles_(triangles) {}

  /// Returns the number of nodes that passed through a triangle since the last call: over it before and after, on
  /// different sides.
  int find(const HostState& state) {
    std::vector<double> heights;
    for (const auto& t : model_.bodies[triangles_].network->triangles) {
      const Vector3d a = positionOf(model_, triangles_, t[0], state),
                     ab = positionOf(model_, triangles_, t[1], state) - a,
                     ac = positionOf(model_, triangles_, t[2], state) - a;
      forEachNode(model_, nodes_, state,
                  [&](const Vector3d& x, const Vector3d&) { heights.push_back(heightOver(x - a, ab, ac)); });
    }
    int passed = 0;
    for (size_t i = 0; i < last_.size(); ++i) passed += last_[i] * heights[i] < 0;
    last_ = heights;
    return passed;
  }

 private:
  /// Returns the height along the triangle's normal [m]; NaN outside it, and farther away than a node can move in a
  /// substep.
  static double heightOver(const Vector3d& ax, const Vector3d& ab, const Vector3d& ac) {
    const Vector3d n = ab.cross(ac);
    const double s = ax.cross(ac).dot(n) / n.squaredNorm(), r = ab.cross(ax).dot(n) / n.squaredNorm();
    const double height = ax.dot(n) / n.norm();
    return s >= 0 && r >= 0 && s + r <= 1 && std::abs(height) < 2 * kSpacing_m ? height : std::nan("");
  }
  const Model& model_;
  size_t nodes_, triangles_;
  std::vector<double> last_;
};

/// A sheet thrown down onto another one.
struct Encounter {
  Model model;
  Scene scene;
  HostState state;
  double speed_m_per_s;  ///< relative
};

/// Returns two sheets that meet. @param cells  relative displacement along z in a substep, in cells of the search, of
/// the fastest nodes
Encounter sheetsMeeting(double cells, uint32_t seed, bool held) {
  Encounter e;
  Body top = looseCloth(6, 6, kSpacing_m), bottom = looseCloth(14, 14, kSpacing_m);
  if (held) {
    for (const uint32_t slot : bottom.lattice.active_slots) bottom.lattice.nodes[slot].lo |= layout::kFixedBit;
  }
  e.model = modelOf({top, bottom});
  e.scene = collidingScene(e.model);
  e.speed_m_per_s = cells * collisionCell(e.model, e.scene.collision) * e.scene.solver.tick_hz;
  std::mt19937 random(seed);
  const Vector3d shift = randomVector(random, 0.5 * kSpacing_m);
  e.state = restState(e.model);
  const double share = held ? 1 : 0.5;
  place(e.model, 0, at(shift.x(), shift.y(), 1.3 * kSpacing_m + std::abs(shift.z())),
        Vector3d(0, 0, -share * e.speed_m_per_s), e.state);
  place(e.model, 1, at(0, 0, 0), Vector3d(0, 0, (1 - share) * e.speed_m_per_s), e.state);
  for (const uint32_t slot : top.lattice.active_slots) {  // every node has a speed of its own, also sideways
    layout::vec4& v = e.state.velocity_m_per_s[slot];
    const Vector3d r = randomVector(random, 1);
    v = vec4(xyz(v) * (1 - 0.3 * std::abs(r.z())) + 0.2 * e.speed_m_per_s * Vector3d(r.x(), r.y(), 0));
  }
  return e;
}

}  // namespace

TEST_P(Collide, SheetsThatMeetAtHalfACellPerSubstepDoNotPassThroughEachOther) {
  constexpr int kSubsteps = 60;
  for (const bool held : {true, false}) {
    for (const double cells : {0.5, 0.25, 0.05}) {
      for (const uint32_t seed : {1u, 2u}) {
        SCOPED_TRACE("seed " + std::to_string(seed) + ", cells " + std::to_string(cells) + (held ? ", held" : ""));
        const Encounter e = sheetsMeeting(cells, seed, held);
        const auto solver = make(e.model, e.scene);
        solver->writeState(e.state);
        Passages down(e.model, 0, 1), up(e.model, 1, 0);
        for (int s = 0; s < kSubsteps; ++s) {
          solver->step({});
          const HostState state = solver->readState();
          EXPECT_EQ(down.find(state) + up.find(state), 0) << s;
        }
      }
    }
  }
}

/// The tests around this one rely on it: passages are detected where there are some.
TEST_P(Collide, SheetsPassThroughEachOtherWhereNothingCollides) {
  Encounter e = sheetsMeeting(0.25, 1, false);
  e.scene.collision.enabled = false;
  const auto solver = make(e.model, e.scene);
  solver->writeState(e.state);
  Passages down(e.model, 0, 1);
  int passed = 0;
  for (int s = 0; s < 20; ++s) {
    solver->step({});
    passed += down.find(solver->readState());
  }
  EXPECT_GT(passed, 30);
}

TEST_P(Collide, ASmallPieceShotAtASheetDoesNotPassWhereverItHits) {
  const Body shot = looseCloth(2, 2, 0.1 * kSpacing_m), sheet = looseCloth(9, 9, kSpacing_m);
  const Model model = modelOf({shot, sheet});
  Scene scene = collidingScene(model);
  const double speed = 0.5 * collisionCell(model, scene.collision) * scene.solver.tick_hz;
  std::mt19937 random(7);
  for (int trial = 0; trial < 12; ++trial) {
    const Vector3d where = randomVector(random, kSpacing_m);
    HostState state = restState(model);
    place(model, 0, at(where.x(), where.y(), 1.5 * kSpacing_m + where.z() / 2), Vector3d(0, 0, -speed), state);
    const auto solver = make(model, scene);
    solver->writeState(state);
    Passages passages(model, 0, 1);
    for (int s = 0; s < 40; ++s) {
      solver->step({});
      EXPECT_EQ(passages.find(solver->readState()), 0) << "trial " << trial << ", substep " << s;
    }
  }
}

TEST_P(Collide, MomentaAddUpToWhatTheyWere) {
  const Encounter e = sheetsMeeting(0.3, 9, false);
  Scene scene = e.scene;
  scene.collision.restitution = 0.5;
  const auto solver = make(e.model, scene);
  solver->writeState(e.state);
  const Vector3d before = momentum(e.model, e.state);
  double passing = 0;  // momentum that the sheets have given each other
  for (int s = 0; s < 40; ++s) {
    solver->step({});
    passing = std::max(passing, (momentum(e.model, solver->readState()) - before).norm());
  }
  double given = 0;
  forEachNode(e.model, 0, e.state, [&](const Vector3d&, const Vector3d& v) { given += 8.7e-5 * v.norm(); });
  EXPECT_LT(passing, 1e-5 * given);  // float32: 40 substeps of a hundred roundings each
}

TEST_P(Collide, EnergyDoesNotGrow) {
  for (const double restitution : {0.0, 1.0}) {
    const Encounter e = sheetsMeeting(0.1, 11, false);
    Scene scene = e.scene;
    scene.collision.restitution = restitution;
    const auto solver = make(e.model, scene);
    solver->writeState(e.state);
    const double before = energyOf(e.model, e.state);
    double most = 0;
    for (int s = 0; s < 100; ++s) {
      solver->step({});
      most = std::max(most, energyOf(e.model, solver->readState()));
    }
    EXPECT_LT(most, 1.02 * before);  // velocities are those of half a substep earlier
  }
}

TEST_P(Collide, RestitutionOneThrowsBackAndNoneStops) {
  Body ball = looseCloth(3, 3, kSpacing_m), wall = looseCloth(3, 3, kSpacing_m);
  for (const uint32_t slot : wall.lattice.active_slots) wall.lattice.nodes[slot].lo |= layout::kFixedBit;
  const Model model = modelOf({ball, wall});
  for (const double restitution : {0.0, 0.5, 1.0}) {
    Scene scene = collidingScene(model);
    scene.collision.restitution = restitution;
    HostState state = restState(model);
    place(model, 0, at(0, 0, 1.2 * kSpacing_m), Vector3d(0, 0, -1), state);  // node over node: all at once
    const auto solver = make(model, scene);
    solver->writeState(state);
    for (int s = 0; s < 40; ++s) solver->step({});
    forEachNode(model, 0, solver->readState(), [&](const Vector3d& x, const Vector3d& v) {
      EXPECT_NEAR(v.z(), restitution, 1e-3);
      EXPECT_GT(x.z(), 0.8 * kSpacing_m);
    });
  }
}

/// A sheet that slides on another one. Its nodes are so close together that it is nearly flat.
class Sliding : public Collide {
 protected:
  /// @param longer  substep over leapfrog's
  void slide(double friction, Integrator integrator = Integrator::kLeapfrog, int longer = 1) {
    const int substeps = static_cast<int>(115 / friction) / longer;
    Body top = looseCloth(3, 3, kSpacing_m), bottom = looseCloth(18, 32, 0.25 * kSpacing_m);
    for (const uint32_t slot : bottom.lattice.active_slots) bottom.lattice.nodes[slot].lo |= layout::kFixedBit;
    const Model model = modelOf({top, bottom});
    Scene scene = collidingScene(model);
    scene.environment.gravity_m_per_s2 = Vector3d(0, 0, -kGravity_m_per_s2);
    scene.solver.integrator = integrator;
    scene.solver.tick_hz /= longer;
    scene.solver.substeps = 1;
    scene.collision.friction = friction;
    scene.collision.distance_m = kSpacing_m;
    HostState state = restState(model);
    place(model, 0, at(-0.02, 0, 0.98 * kSpacing_m), Vector3d(0.3, 0, 0), state);
    const auto solver = make(model, scene);
    solver->writeState(state);
    dt_s_ = solver->dt_s();
    speeds_.clear();
    for (int s = 0; s < substeps; ++s) {
      solver->step({});
      Vector3d sum = Vector3d::Zero();
      forEachNode(model, 0, solver->readState(), [&](const Vector3d&, const Vector3d& v) { sum += v / 9; });
      speeds_.push_back(sum.x());
    }
  }
  /// Returns the deceleration after it has settled and before it rests [m/s2].
  double deceleration() const {
    constexpr double kLies_s = 0.015, kSlow_m_per_s = 0.06;
    const auto first = static_cast<size_t>(kLies_s / dt_s_);
    size_t last = first;
    while (last + 1 < speeds_.size() && speeds_[last] > kSlow_m_per_s) ++last;
    return (speeds_[first] - speeds_[last]) / (static_cast<double>(last - first) * dt_s_);
  }

  std::vector<double> speeds_;  ///< [substeps] mean speed of the upper sheet's nodes [m/s]
  double dt_s_ = 0;
};
INSTANTIATE_TEST_SUITE_P(Backends, Sliding, ::testing::ValuesIn(backendKinds()), backendSuffix);

TEST_P(Sliding, ASheetOnAnotherSlowsByFrictionTimesGravityAndThenRests) {
  constexpr double kLaw = 0.1;  // of mu g: nodes are round, and the sheet hops over those below
  constexpr double kFriction = 0.6;
  slide(kFriction);
  EXPECT_NEAR(deceleration() / (kFriction * kGravity_m_per_s2), 1, kLaw);
  EXPECT_NEAR(speeds_.back(), 0, 1e-4) << "it has not come to rest";
}

TEST_P(Sliding, WithinPdItSlowsBySoMuchToo) {
  constexpr double kLaw = 0.1;     // as above
  slide(0.3, Integrator::kPd, 4);  // 2 dt_safe
  EXPECT_NEAR(deceleration() / (0.3 * kGravity_m_per_s2), 1, kLaw);
  EXPECT_NEAR(speeds_.back(), 0, 1e-4) << "it has not come to rest";
}

TEST_P(Collide, NodesTooFarFromEachOtherDoNothingAtAll) {
  const Encounter e = sheetsMeeting(0.0, 3, false);
  const auto with = make(e.model, e.scene);
  Scene off = e.scene;
  off.collision.enabled = false;
  const auto without = make(e.model, off);
  HostState state = e.state;
  place(e.model, 0, at(0, 0, 0.1), Vector3d(0.1, 0.2, 0.3), state);
  for (const auto& solver : {with.get(), without.get()}) {
    solver->writeState(state);
    for (int s = 0; s < 20; ++s) solver->step({});
  }
  EXPECT_EQ(stateHash(e.model, with->readState()), stateHash(e.model, without->readState()));
}

TEST_P(Collide, TheSameSceneGivesTheSameBits) {
  const Encounter e = sheetsMeeting(0.4, 5, false);
  const auto hash = [&](const std::unique_ptr<TissueStepper>& solver) {
    solver->writeState(e.state);
    for (int s = 0; s < 50; ++s) solver->step({});
    return stateHash(e.model, solver->readState());
  };
  const uint64_t first = hash(make(e.model, e.scene));
  EXPECT_EQ(hash(make(e.model, e.scene)), first);
  if (GetParam() == "gpu") {
    EXPECT_EQ(hash(std::make_unique<GpuSolver>(e.model, e.scene, GpuSolverOptions{{}, 32})), first);
    EXPECT_EQ(hash(std::make_unique<GpuSolver>(e.model, e.scene, GpuSolverOptions{{}, 256})), first);
  } else {
    EXPECT_EQ(hash(makeCpu(GetParam().substr(4), e.model, e.scene, 1)), first);
  }
}
