// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "solver/reference/reference_bodies.h"
#include "solver/reference/statics.h"
#include "tools/motion_packing.h"

namespace viscera {
namespace {

using namespace test;

constexpr ReferenceIntegrator kAll[] = {ReferenceIntegrator::kLeapfrog, ReferenceIntegrator::kVerletPaper,
                                        ReferenceIntegrator::kImplicitEuler};

ReferenceOptions with(ReferenceIntegrator integrator) {
  ReferenceOptions options;
  options.integrator = integrator;
  return options;
}

/// A standing block that starts with a smooth bend and oscillates, with the given drag and dashpot.
class Swing {
 public:
  Swing(double mass_damping_per_s, double stiffness_damping_ratio) {
    Body body = standing(unitBody({2, 2, 3}));
    body.material.mass_damping_per_s = mass_damping_per_s;
    body.material.stiffness_damping_ratio = stiffness_damping_ratio;
    model_ = modelOf({body});
  }
  double dtSafe_s() const { return safeTimeStep(model_); }
  Field after(int steps, double dt_s, ReferenceIntegrator integrator) const {
    ReferenceSolver solver(model_, Vector3d::Zero(), dt_s, with(integrator));
    for (uint32_t slot : solver.active) {
      const double z = solver.restPosition(slot).z();
      solver.u_m[slot] = Vector3d(0.02 * z * z, 0, -0.01 * z);
      solver.v_m_per_s[slot] = Vector3d(0, 0.03 * z, 0);
    }
    for (int i = 0; i < steps; ++i) solver.substep();
    return solver.u_m;
  }
  /// Returns log2 of the ratio of errors when the substep is halved; the reference solution has `finer` times shorter
  /// substeps.
  double order(ReferenceIntegrator integrator, double fraction, int steps, int finer) const {
    const double dt = fraction * dtSafe_s();
    const Field truth = after(steps * finer, dt / finer, integrator);
    const double coarse = error(after(steps, dt, integrator), truth);
    return std::log2(coarse / error(after(2 * steps, dt / 2, integrator), truth));
  }
  static double error(const Field& a, const Field& b) {
    double sum = 0;
    for (size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]).squaredNorm();
    return std::sqrt(sum);
  }

 private:
  Model model_;
};

/// Returns the residual of m (v+ - v)/dt = F(u+) + m g - gamma m v+ and u+ = u + dt v+, per node, over the largest
/// force.
double implicitEulerError(const ReferenceSolver& before, const ReferenceSolver& after, double dt_s) {
  double error = 0, largest = 0;
  for (uint32_t slot : after.active) {
    if (isFixed(after.nodes[slot])) continue;
    const double m = after.mass(slot);
    const Vector3d force = after.force(slot);
    const Vector3d balance = m * (after.v_m_per_s[slot] - before.v_m_per_s[slot]) / dt_s - force - m * after.gravity() +
                             m * after.mass_damping_per_s(slot) * after.v_m_per_s[slot];
    const Vector3d motion = after.u_m[slot] - before.u_m[slot] - dt_s * after.v_m_per_s[slot];
    error = std::max({error, balance.norm(), motion.norm()});
    largest = std::max(largest, force.norm());
  }
  return error / largest;
}

SubstepMotions probeAt(const Vector3d& from, const Vector3d& to, double radius_m) {
  SubstepMotions motions{};
  motions[0].from = {static_cast<float>(from.x()), static_cast<float>(from.y()), static_cast<float>(from.z()),
                     static_cast<float>(radius_m)};
  motions[0].to = {static_cast<float>(to.x()), static_cast<float>(to.y()), static_cast<float>(to.z()), 1};
  motions[0].orientation = {0, 0, 0, 1};
  motions[0].info = toolInfo(ToolMode::kProbe);
  return motions;
}

}  // namespace

TEST(ReferenceLeapfrog, KeepsVerletsInvariant) {
  const Body body = standing(unitChain(2));
  const Model model = modelOf({body});
  const double dt = 0.7 * safeTimeStep(model);
  ReferenceSolver solver(model, Vector3d::Zero(), dt);
  const uint32_t free = slotAt(body, 0, 0, 1);
  solver.u_m[free].z() = 0.1;
  const auto invariant = [&](double x, double next) {
    return 0.5 * (next - x) * (next - x) + 0.5 * dt * dt * x * next;  // omega = 1
  };
  solver.substep();
  double x = 0.1, first = invariant(x, solver.u_m[free].z());
  for (int i = 0; i < 10000; ++i) {
    x = solver.u_m[free].z();
    solver.substep();
    ASSERT_NEAR(invariant(x, solver.u_m[free].z()) / first, 1, 1e-11) << i;  // rounding of 10^4 substeps
  }
}

TEST(ReferenceLeapfrog, IsOfSecondOrder) {
  EXPECT_NEAR(Swing(0, 0).order(ReferenceIntegrator::kLeapfrog, 0.4, 40, 16), 2, 0.1);    // issue 3
  EXPECT_NEAR(Swing(0.5, 0).order(ReferenceIntegrator::kLeapfrog, 0.4, 40, 16), 2, 0.1);  // drag is symmetric
}

TEST(ReferenceImplicitEuler, IsOfFirstOrder) {
  // The reference solution must be much finer here: at dt / 16 its own error would appear as a slope of 1.1.
  EXPECT_NEAR(Swing(0.5, 0.2).order(ReferenceIntegrator::kImplicitEuler, 0.2, 10, 128), 1, 0.1);  // issue 3
}

TEST(ReferenceVerletPaper, IsOfFirstOrderForItsDrag) {
  EXPECT_NEAR(Swing(0.5, 0).order(ReferenceIntegrator::kVerletPaper, 0.2, 80, 64), 1, 0.1);
}

TEST(ReferenceLeapfrog, KicksOverTheMeanOfTwoSubsteps) {
  Body body = unitChain(2);
  const Model model = modelOf({body});
  ReferenceSolver solver(model, Vector3d(0, 0, -10), 0.1);
  const uint32_t slot = slotAt(body, 0, 0, 0);
  solver.substep();
  EXPECT_DOUBLE_EQ(solver.v_m_per_s[slot].z(), -0.5);
  solver.setSubstep(0.3);
  solver.substep();
  EXPECT_DOUBLE_EQ(solver.v_m_per_s[slot].z(), -2.5);  // 10 (0.1 + 0.3) / 2 more
  solver.substep();
  EXPECT_DOUBLE_EQ(solver.v_m_per_s[slot].z(), -5.5);
  EXPECT_DOUBLE_EQ(solver.u_m[slot].z(), -0.1 * 0.5 - 0.3 * 2.5 - 0.3 * 5.5);
}

TEST(ReferenceImplicitEuler, SolvesItsEquation) {
  Body body = standing(unitBody({2, 2, 3}));
  body.material.mass_damping_per_s = 0.7;
  body.material.stiffness_damping_ratio = 0.3;
  const Model model = modelOf({body});
  for (double fraction : {0.5, 10.0, 100.0}) {
    const double dt = fraction * safeTimeStep(model);
    ReferenceSolver solver(model, Vector3d(0, 0, -0.05), dt, with(ReferenceIntegrator::kImplicitEuler));
    solver.u_m = randomField(solver, 0.1, 1);
    solver.v_m_per_s = randomField(solver, 0.1, 2);
    for (uint32_t slot : solver.active) {
      if (isFixed(solver.nodes[slot])) solver.u_m[slot] = solver.v_m_per_s[slot] = Vector3d::Zero();
    }
    for (int i = 0; i < 3; ++i) {
      const ReferenceSolver before = solver;
      solver.substep();
      EXPECT_LT(implicitEulerError(before, solver, dt), 1e-8) << "dt / dt_safe " << fraction;
    }
  }
}

TEST(ReferenceImplicitEuler, NeverGainsEnergyFromExtremeStarts) {
  const Model model = modelOf({unitBody({3, 3, 3})});
  for (double collapse : {1.0, 0.999, 2.0, -9.0}) {  // to a point, nearly, mirrored, ten times as large
    ReferenceSolver solver(model, Vector3d::Zero(), 10 * safeTimeStep(model),
                           with(ReferenceIntegrator::kImplicitEuler));
    for (uint32_t slot : solver.active) solver.u_m[slot] = -collapse * solver.restPosition(slot);
    double last = solver.energy();
    const double start = std::abs(last);
    for (int i = 0; i < 10; ++i) {
      solver.substep();
      EXPECT_LE(solver.energy(), last + 1e-12 * start) << "start " << collapse << " substep " << i;
      last = solver.energy();
    }
  }
}

TEST(ReferenceTools, ToolsGiveAllTheMomentumThereIs) {
  for (ReferenceIntegrator integrator : kAll) {
    Body body = unitBody({3, 3, 3});
    body.material.stiffness_damping_ratio = 0.2;
    const Model model = modelOf({body});
    const double dt = 0.4 * safeTimeStep(model);
    ReferenceSolver solver(model, Vector3d::Zero(), dt, with(integrator));
    Pose grip{Vector3d(3, 3, 3), Quaterniond::Identity()};
    solver.takeHold(1, grip, 1.2);
    for (int i = 0; i < 10; ++i) {
      const double x = -0.9 + 0.02 * i;
      SubstepMotions motions = probeAt({x, 1.5, 1.5}, {x + 0.02, 1.5, 1.5}, 1.2);
      grip.position_m.z() += 0.02;
      motions[1] = probeAt(grip.position_m, grip.position_m, 1.2)[0];
      motions[1].info = toolInfo(ToolMode::kGrab);
      solver.substep(motions);
    }
    const Vector3d given = solver.impulse_n_s[0] + solver.impulse_n_s[1];
    EXPECT_GT(solver.impulse_n_s[0].x(), 0.01);
    EXPECT_GT(solver.impulse_n_s[1].z(), 0.01);
    EXPECT_LT((given - solver.momentum()).norm(), 1e-9 * given.norm()) << static_cast<int>(integrator);
    const uint32_t held = slotAt(body, 3, 3, 3);
    EXPECT_NEAR(solver.u_m[held].z(), 0.2, 1e-6);  // motions are float32
  }
}

TEST(ReferenceTools, ProbePushesNodesOutNoFasterThanAllowed) {
  const Body body = unitBody({2, 2, 2});
  const Model model = modelOf({body});
  ReferenceOptions options;
  options.push_speed_m_per_s = 2;
  options.integrator = ReferenceIntegrator::kVerletPaper;  // with probes that touch nodes only
  constexpr double kDt = 0.05;
  ReferenceSolver solver(model, Vector3d::Zero(), kDt, options);
  const uint32_t corner = slotAt(body, 0, 0, 0);
  const SubstepMotions motions = probeAt({-0.1, 0, 0}, {-0.1, 0, 0}, 0.5);
  solver.substep(motions);
  EXPECT_NEAR(solver.u_m[corner].x(), 2 * kDt, 1e-12);
  for (int i = 0; i < 10; ++i) solver.substep(motions);
  EXPECT_GT((solver.u_m[corner] - Vector3d(-0.1, 0, 0)).norm(), 0.5 - 1e-6);  // out of it; motions are float32
}

TEST(ReferenceSleep, StopsFragmentsThatFallAndLetsOthersComeBack) {
  const Body body = unitChain(2);
  const Model model = modelOf({body});
  for (ReferenceIntegrator integrator : kAll) {
    ReferenceOptions options = with(integrator);
    options.sleep_distance_m = 1;
    ReferenceSolver solver(model, Vector3d(0, 0, -10), 0.01, options);
    for (int i = 0; i < 200; ++i) solver.substep();
    for (uint32_t slot : solver.active) {
      EXPECT_LE(solver.u_m[slot].norm(), 1.0);
      EXPECT_GT(solver.u_m[slot].norm(), 0.5);
    }
    for (uint32_t slot : solver.active) {
      solver.u_m[slot] = Vector3d(0, 0, -3);
      solver.v_m_per_s[slot] = Vector3d(0, 0, 2);
    }
    solver.substep();
    EXPECT_GT(solver.u_m[slotAt(body, 0, 0, 0)].z(), -3.0);
  }
}

TEST(ReferenceSolver, CutThroughTheMiddleKillsTheCellsBetween) {
  const Body body = unitBody({3, 2, 2});
  const Model model = modelOf({body});
  ReferenceSolver solver(model, Vector3d::Zero(), 0.01);
  SubstepMotions motions{};
  motions[0].from = {1.5f, -1, 3, 0.1f};
  motions[0].blade_from = {1.5f, -1, -1, 0};
  motions[0].to = {1.5f, 3.1f, 3, 0};
  motions[0].blade_to = {1.5f, 3.1f, -1, 0};
  motions[0].info = toolInfo(ToolMode::kCut);
  solver.substep(motions);
  EXPECT_EQ(solver.springs_cut, 9u + 2 * 12);  // 3 x 3 along x; two diagonals on each of 2 x 3 + 3 x 2 faces
  for (uint32_t slot : solver.active) {
    const Vector3i at = body.lattice.nodeAt(slot);
    const bool cell = at.x() < 3 && at.y() < 2 && at.z() < 2;
    EXPECT_EQ((solver.nodes[slot].lo & layout::kCellBit) != 0, cell && at.x() != 1) << at.transpose();
  }
}

}  // namespace viscera
