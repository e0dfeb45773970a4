// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// Tissue continued on other lattices of the same bodies: its motion, its cuts and what follows them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "session/on_backends.h"
#include "solver/tissue/carried_tissue.h"
#include "viscera/math/error.h"

namespace viscera {
namespace {

using namespace test;

constexpr double kFine_m = 0.004, kCoarse_m = 0.0053;
constexpr double kFloats_m = 1e-7;  ///< float resolution of some centimetres, with the sums of a fit

class Carried : public OnSceneBackend {
 protected:
  static Scene spaced(double spacing_m, bool held = true) {
    Scene out = scene();
    out.bodies[0].spacing_m = spacing_m;
    if (!held) out.bodies[0].fixed.clear();
    return out;
  }
  /// Makes a session. Those on the GPU share their context; those on the CPU need none, and their views would keep it.
  Session made(const Scene& scene) {
    if (scene.solver.backend == Backend::kCpu) return Session(scene);
    return {scene, context_};
  }
  /// Sets a linear state: stretched, rotated and sheared, and moving.
  static void setLinear(const Body& body, HostState& state) {
    for (const uint32_t slot : body.lattice.active_slots) {
      const Vector3d at = restPosition(body, slot);
      state.displacement_m[slot] = toVec4(kField * at + kShift_m);
      state.velocity_m_per_s[slot] = toVec4(10 * kField * at);
    }
  }
  static layout::vec4 toVec4(const Vector3d& v) {
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()), 0};
  }
  static Vector3d of(const layout::vec4& v) { return {v.x, v.y, v.z}; }
  static const Matrix3d kField;
  static const Vector3d kShift_m;
};
const Matrix3d Carried::kField = (Matrix3d() << 0.1, -0.03, 0.02, 0.04, -0.05, 0.06, 0, 0.01, 0.08).finished();
const Vector3d Carried::kShift_m(0.001, -0.002, 0.003);

TEST_P(Carried, ALinearMotionIsCarriedAsItIs) {
  Session old = made(spaced(kFine_m, false));
  for (const double spacing_m : {kCoarse_m, 0.0031}) {
    Session next = made(spaced(spacing_m, false));
    CarriedTissue tissue = old.carried();
    setLinear(old.model().bodies[0], tissue.state);
    const HostState state = carriedState(tissue, next.model(), next.solver().readState());
    for (const uint32_t slot : next.model().bodies[0].lattice.active_slots) {
      const Vector3d at = next.model().bodies[0].lattice.restPosition(slot);
      EXPECT_LT((of(state.displacement_m[slot]) - kField * at - kShift_m).norm(), kFloats_m);
      EXPECT_LT((of(state.velocity_m_per_s[slot]) - 10 * kField * at).norm(), 10 * kFloats_m);
    }
  }
}

TEST_P(Carried, TheSameLatticeIsCarriedToTheBit) {
  Session old = made(spaced(kFine_m)), next = made(spaced(kFine_m));
  play(old, cut, kCutTicks);
  next.carry(old.carried());
  EXPECT_EQ(next.stateHash(), old.stateHash());
}

/// Springs that cross the plane of the blade's path are cut above its tip and whole below; no other spring is cut.
TEST_P(Carried, ACutIsWhereItWas) {
  constexpr double kPlaneY_m = 0.001, kTipZ_m = 0.001;
  constexpr double kShare = 0.05;  // resolution of the position of a cut; its least distance from nodes (CutSprings)
  Session old = made(spaced(kFine_m)), next = made(spaced(kCoarse_m));
  play(old, cut, kCutTicks);
  next.carry(old.carried());
  const HostState state = next.solver().readState();
  const Lattice& lattice = next.model().bodies[0].lattice;
  int opened = 0, left_whole = 0;
  for (const uint32_t slot : lattice.active_slots) {
    for (uint32_t s = 0; s < layout::kSpringsPerNode; s += 2) {
      const int64_t there = lattice.neighborSlot(slot, s);
      if (there < 0 || springCount(lattice.nodes[slot], s) == 0) continue;
      const Vector3d a = lattice.restPosition(slot), b = lattice.restPosition(static_cast<uint32_t>(there));
      const bool whole = springCount(state.nodes[slot], s) != 0;
      EXPECT_EQ(whole, springCount(state.nodes[static_cast<size_t>(there)], oppositeSpring(s)) != 0);
      const bool crosses = (a.y() < kPlaneY_m) != (b.y() < kPlaneY_m);
      if (!crosses || std::max(a.z(), b.z()) < kTipZ_m - 1.5 * kFine_m) {
        EXPECT_TRUE(whole) << a.transpose() << " to " << b.transpose();
        left_whole += crosses;
      } else if (std::min(a.z(), b.z()) > kTipZ_m + 1.5 * kFine_m) {
        EXPECT_FALSE(whole) << a.transpose() << " to " << b.transpose();
        ++opened;
        if (!isAxial(s)) continue;
        const double at_m = a.y() + state.axial_cut[3 * slot + s / 2] * (b.y() - a.y());
        EXPECT_NEAR(at_m, kPlaneY_m, kShare * kCoarse_m);
      }
    }
  }
  EXPECT_GT(opened, 50);
  EXPECT_GT(left_whole, 50);
  EXPECT_EQ(next.solver().readState().nodes.size(), lattice.nodes.size());
}

/// What an eraser removed is missing in the new lattice too.
TEST_P(Carried, WhatWasErasedIsErased) {
  constexpr double kHole_m = 0.01;
  const auto eroding = [](double spacing_m) {
    Scene out = spaced(spacing_m);
    out.styluses[0].button2 = ToolMode::kCutParticles;
    out.styluses[0].cut_particles.eraser_radius_m = kHole_m;
    return out;
  };
  Session old = made(eroding(kFine_m)), next = made(eroding(kCoarse_m));
  play(
      old,
      [](int /*tick*/) {
        return leftAt({0, 0, kHalfM}, false, true);
      },
      3);
  next.carry(old.carried());
  const HostState state = next.solver().readState();
  const Lattice& lattice = next.model().bodies[0].lattice;
  int gone = 0;
  for (const uint32_t slot : lattice.active_slots) {
    const double far_m = (lattice.restPosition(slot) - Vector3d(0, 0, kHalfM)).norm();
    const bool isolated =
        (state.nodes[slot].lo & layout::kAxialMask) == 0 && (state.nodes[slot].hi & layout::kDiagonalMask) == 0;
    if (std::abs(far_m - kHole_m) > kFine_m) {
      EXPECT_EQ(isolated, far_m < kHole_m) << lattice.restPosition(slot).transpose();
    }
    gone += isolated;
  }
  EXPECT_GT(gone, 5);
}

/// A block hanging under its own weight stays at rest: fixed positions differ slightly between lattices, which makes it
/// oscillate a little.
TEST_P(Carried, TissueAtRestStaysSo) {
  constexpr double kSeconds = 1.5, kSwing = 0.1;  // of the sag: hardly visible; started from rest it would be 1
  const auto heavy = [](double spacing_m) {
    Scene out = spaced(spacing_m);
    out.environment.gravity_m_per_s2 = Vector3d(9.81, 0, 0);
    out.bodies[0].material.young_modulus_pa = 10000;
    return out;
  };
  const auto hang = [](Session& session, double seconds) {
    for (int t = 0; t * session.tick_s() < seconds; ++t) session.step({}, {});
    session.drain();
  };
  // of the surface mesh: nodes outside it move farther the coarser the lattice
  const auto sag_m = [](Session& session) {
    const std::vector<float> rest = restPositions(session), now = surfaceAfter(session, {}).positions_m;
    float most_m = 0;
    for (size_t i = 0; i < rest.size(); i += 3) most_m = std::max(most_m, now[i] - rest[i]);
    return static_cast<double>(most_m);
  };
  Session old = made(heavy(kFine_m)), next = made(heavy(kCoarse_m));
  hang(old, kSeconds);
  hang(next, kSeconds);
  const double before_m = sag_m(old), own_m = sag_m(next);
  EXPECT_NEAR(before_m, own_m, 0.1 * own_m);
  next.carry(old.carried());
  for (int part = 0; part < 6; ++part) {
    hang(next, 0.05);
    EXPECT_NEAR(sag_m(next), own_m, kSwing * own_m) << part;
  }
  EXPECT_EQ(next.solver().health().trips, 0U);
}

TEST_P(Carried, OtherBodiesAreRefused) {
  Scene other = spaced(kCoarse_m);
  other.bodies[0].name = "another";
  Session old = made(spaced(kFine_m)), next = made(other);
  const CarriedTissue tissue = old.carried();
  EXPECT_THROW(next.carry(tissue), Error);
}

VISCERA_ON_EVERY_BACKEND(Carried);

}  // namespace
}  // namespace viscera
