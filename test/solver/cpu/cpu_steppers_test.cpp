// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/cpu_stepper.h"

#include <thread>

#include "solver/cpu/pd.h"
#include "solver/cpu/tool_passes.h"
#include "support/features.h"
#include "support/implicit.h"
#include "tools/motion_packing.h"

using namespace viscera;
using namespace viscera::test;

namespace {

// Relative to the largest value, after three substeps of 3 dt_safe with iterations enough that more change nothing:
// float32 rounding of increments and of their sum. As for the GPU.
constexpr double kConverged = 2e-6;
constexpr int kIterations = 160;
constexpr int kSubsteps = 3;
// Absolute positions of tools, rounded at 6e-8 of 0.05 m, on displacements of 3e-3 m. As for the GPU.
constexpr double kConvergedWithTools = 1e-5;

/// Each job on a thread of its own, the last one first; ranges in the smallest portions.
class Scattered : public Parallel {
 protected:
  void run(size_t count, Portions portions, Call call, const void* job) const override {
    std::vector<std::thread> threads;
    for (size_t end = count; end > 0;) {
      const size_t first = (end - 1) / portions.least * portions.least;
      threads.emplace_back(call, job, first, end);
      end = first;
    }
    for (std::thread& thread : threads) thread.join();
  }
};

/// A lattice and what a solver tells an integrator of a substep.
class Rig {
 public:
  Rig(const Model& model, double fraction, const Vector3d& gravity = Vector3d::Zero())
      : model_(model), lattice(model, bodyParams(model, safeTimeStep(model)), featuresFor(model, true)) {
    const double dt_safe_s = safeTimeStep(model);
    features = featuresFor(model, true);
    step.dt_s = static_cast<float>(fraction * (std::isfinite(dt_safe_s) ? dt_safe_s : 1e-3));
    step.gravity = gravity.cast<float>();
    step.sleep_distance_m = 1e6;
    step.push_speed_m_per_s = static_cast<float>(pushSpeed(model));
    step.restarted = true;
    step.kick_s = 0.5f * step.dt_s;
  }
  void run(CpuStepper& stepper, const layout::ToolMotion* motions = nullptr) {
    stepper.run(lattice, step, motions);
    lattice.swap();
    step.restarted = false;
    step.kick_s = step.dt_s;
  }
  CpuParts with(const Parallel& parallel) { return {parallel, sleep, nullptr, features, kernels}; }
  ReferenceSolver reference(ReferenceIntegrator integrator) const {
    ReferenceOptions options;
    options.integrator = integrator;
    options.push_speed_m_per_s = static_cast<double>(step.push_speed_m_per_s);
    ReferenceSolver out(model_, step.gravity.cast<double>(), static_cast<double>(step.dt_s), options);
    load(out, lattice.read());
    return out;
  }

 private:
  const Model& model_;

 public:
  CpuLattice lattice;
  Sleep sleep{lattice, 0};
  FeatureSet features;
  simd::Kernels kernels = simd::kernelsFor("").value();
  Substep step;
};

void expectLikeReference(const Model& model, const Vector3d& gravity) {
  Rig rig(model, 3, gravity);
  rig.lattice.write(randomState(model, 0.05 * model.bodies[0].lattice.spacing_m, 0.1, 7));
  ReferenceSolver reference = rig.reference(ReferenceIntegrator::kImplicitEuler);
  const Serial serial;
  const auto stepper = makeCpuStepper(Integrator::kPd, kIterations, rig.lattice, rig.with(serial));
  for (int s = 0; s < kSubsteps; ++s) {
    rig.run(*stepper);
    reference.substep();
  }
  const HostState end = rig.lattice.read();
  EXPECT_LT(relativeError(end.displacement_m, reference.u_m, reference.active), kConverged);
  EXPECT_LT(relativeError(end.velocity_m_per_s, reference.v_m_per_s, reference.active), kConverged);
}

Model rubberBox(const Vector3i& cells, double poisson_ratio) {
  Body body = boxBody(cells, 0.01);
  body.material.poisson_ratio = poisson_ratio;
  return modelOf({body});
}

/// Substeps from a start that no gentle simulation meets, without gravity and drag.
void expectEnergyBelowStart(CpuStepper& stepper, Rig& rig, const Model& model, Abuse abuse) {
  constexpr double kAllowed = 0.01;    // of the start: the stability suite's limit
  constexpr double kNothing_j = 1e-9;  // float32 rounding of a body at rest: 1e-7 h in every spring is 1e-14 J
  SCOPED_TRACE(static_cast<int>(abuse));
  const HostState start = abusedState(model, abuse);
  rig.lattice.write(start);
  const double start_j = energyOf(model, start);
  for (int t = 0; t < 8; ++t) {
    rig.run(stepper);
    const HostState state = rig.lattice.read();
    ASSERT_TRUE(isFinite(state.displacement_m) && isFinite(state.velocity_m_per_s)) << t;
    ASSERT_LE(energyOf(model, state), start_j + kAllowed * std::abs(start_j) + kNothing_j) << t;
  }
}

uint64_t hashAfterTools(Integrator integrator, const Model& model, const Parallel& parallel) {
  const PullAndProbe tools;
  Rig rig(model, traitsOf(integrator).is_explicit ? 0.5 : 3);
  rig.lattice.write(randomState(model, 1e-3, 0.5, 11));
  rig.step.tools = true;
  const auto stepper = makeCpuStepper(integrator, 6, rig.lattice, rig.with(parallel));
  for (int t = 0; t < 3; ++t) {
    const ToolMotions motions = tools.motions(t, 0.07);
    if (t == 0) takeHold(rig.lattice, 0, motions[0].from, tools.styluses[0].grab.radius_m);
    std::vector<layout::ToolMotion> rows;
    interpolateMotions(motions, tools.styluses, 1, rows);
    rig.run(*stepper, rows.data());
  }
  return stateHash(model, rig.lattice.read());
}

}  // namespace

TEST(CpuImplicit, MatchesReferenceAtEverySize) {
  for (size_t size : {1, 63, 64, 65}) {
    SCOPED_TRACE(size);
    Body body = blobBody(size, 0.01, 3);
    body.material.drag_per_s = 50;
    expectLikeReference(modelOf({body}), Vector3d(0.3, -0.2, -9.81));
  }
}

TEST(CpuImplicit, MatchesReferenceWithVolumesOfAnyPoissonRatio) {
  for (const double poisson_ratio : {0.0, 0.45, 0.49}) {
    SCOPED_TRACE(poisson_ratio);
    expectLikeReference(rubberBox({4, 4, 4}, poisson_ratio), Vector3d(0, 0, -9.81));
  }
}

TEST(CpuImplicit, MatchesReferenceWithPartsAndFixedNodes) {
  expectLikeReference(modelOf({twoPartBody()}), Vector3d(0, 0, -9.81));
}

TEST(CpuImplicit, KeepsEnergyBelowItsStartWhateverTheStart) {
  const Serial serial;
  for (const double poisson_ratio : {0.25, 0.45}) {
    Body body = boxBody({3, 3, 3}, 0.01);
    body.material.poisson_ratio = poisson_ratio;
    body.material.drag_per_s = 0;
    const Model model = modelOf({body});
    for (const double fraction : {1.0, 10.0, 100.0}) {
      SCOPED_TRACE(::testing::Message() << poisson_ratio << " " << fraction);
      Rig rig(model, fraction);
      for (const Abuse abuse : kAbuses) {
        expectEnergyBelowStart(*makeCpuStepper(Integrator::kPd, 20, rig.lattice, rig.with(serial)), rig, model, abuse);
        expectEnergyBelowStart(*makeCpuRecoveryStepper(20, rig.lattice, serial), rig, model, abuse);
      }
    }
  }
}

/// One sweep is far from a solution: what it leaves of the velocities has more energy than the start, and is not taken.
TEST(CpuImplicit, KeepsEnergyBelowItsStartWithTooFewIterations) {
  const Serial serial;
  Body body = boxBody({3, 3, 3}, 0.01);
  body.material.poisson_ratio = 0.49;
  body.material.drag_per_s = 0;
  const Model model = modelOf({body});
  Rig rig(model, 0.2);
  for (const Abuse abuse : kAbuses)
    expectEnergyBelowStart(*makeCpuStepper(Integrator::kPd, 1, rig.lattice, rig.with(serial)), rig, model, abuse);
}

TEST(CpuImplicit, ToolsActLikeTheReferences) {
  const PullAndProbe tools;
  const Serial serial;
  for (const double poisson_ratio : {0.25, 0.4}) {
    SCOPED_TRACE(poisson_ratio);
    const Model model = rubberBox({4, 4, 4}, poisson_ratio);
    Rig rig(model, 2);
    rig.step.tools = true;
    ReferenceSolver reference = rig.reference(ReferenceIntegrator::kImplicitEuler);
    const auto stepper = makeCpuStepper(Integrator::kPd, kIterations, rig.lattice, rig.with(serial));
    for (int t = 0; t < 3; ++t) {
      const ToolMotions motions = tools.motions(t, 0.04);
      if (t == 0) {
        takeHold(rig.lattice, 0, motions[0].from, tools.styluses[0].grab.radius_m);
        reference.takeHold(0, motions[0].from, tools.styluses[0].grab.radius_m);
      }
      std::vector<layout::ToolMotion> rows;
      interpolateMotions(motions, tools.styluses, 1, rows);
      rig.run(*stepper, rows.data());
      reference.substep({rows[0], rows[1]});
    }
    EXPECT_LT(relativeError(rig.lattice.read().displacement_m, reference.u_m, reference.active), kConvergedWithTools);
    layout::TickStats stats{};
    sumReactions(rig.lattice, {}, stats);
    for (size_t s = 0; s < 2; ++s) {
      const Vector3d given = reference.impulse_n_s[s];
      EXPECT_GT(stats.touched[s], 0u);
      EXPECT_LT((xyz(stats.impulse[s]) - given).norm(), 10 * kConvergedWithTools * given.norm()) << s;
    }
  }
}

TEST(CpuPd, AccelerationReachesAnErrorInFewerIterations) {
  const Model model = modelOf({boxBody({5, 5, 5}, 0.01)});
  Rig rig(model, 5);
  const Serial serial;
  const auto sweepsUntil = [&](bool accelerated) {
    rig.lattice.write(randomState(model, 5e-4, 0.1, 7));
    CpuPd pd(rig.lattice, serial, {400, accelerated});
    rig.run(pd);
    EXPECT_FALSE(pd.gaveUp());
    const std::vector<float> changes = pd.changes();
    size_t last = changes.size();
    while (last > 0 && changes[last - 1] < 1e-4f * changes[0]) --last;
    return last;
  };
  const size_t plain = sweepsUntil(false), accelerated = sweepsUntil(true);
  EXPECT_LT(plain, 400u);
  EXPECT_LT(2 * accelerated, plain) << accelerated << " against " << plain;
}

TEST(CpuPd, SpectralRadiusIsThatOfTheLatticesStiffestNode) {
  Body body = boxBody({4, 4, 4}, 0.01);
  body.material.dashpot_ratio = 0;
  const Model model = modelOf({body});
  Rig rig(model, 3);
  const Serial serial;
  // dt_safe^2 = 2 / max(sum of k / m), so m/dt^2 is (2 / fraction^2) / 2 of sum of k there.
  const double sum_over_inertia = 2 * 3.0 * 3.0;
  EXPECT_NEAR(CpuPd(rig.lattice, serial, {1}).spectralRadius(static_cast<double>(rig.step.dt_s)),
              sum_over_inertia / (1 + sum_over_inertia), 1e-6);  // float32 rates
}

TEST(CpuPd, AccelerationThatGoesWrongIsGivenUpAndStartsAgain) {
  const Model model = modelOf({boxBody({4, 4, 4}, 0.01)});
  Rig rig(model, 3);
  const Serial serial;
  const auto end = [&](const PdOptions& options, bool gives_up) {
    rig.lattice.write(randomState(model, 5e-4, 0.1, 7));
    CpuPd pd(rig.lattice, serial, options);
    rig.run(pd);
    EXPECT_EQ(pd.gaveUp(), gives_up);
    return rig.lattice.read().displacement_m;
  };
  const auto wrong = end({200, true, 1.05}, true), plain = end({200, false}, false);  // no spectrum allows 1.05
  for (uint32_t slot : rig.lattice.store.active)  // it lost the few sweeps before it gave up, no more
    EXPECT_LT((xyz(wrong[slot]) - xyz(plain[slot])).norm(), 1e-3 * 5e-4);
}

/// What the iteration that gave up says of its change is what volumes allow the next ones: it must not be nothing.
TEST(CpuPd, StartsAgainAlsoWhereTheFirstNodeIsFixed) {
  constexpr size_t kWatched = 20;  // iterations, of which an early one gives up
  Body body = boxBody({4, 4, 4}, 0.01);
  body.lattice.nodes[body.lattice.active_slots[0]].lo |= layout::kFixedBit;
  const Model model = modelOf({body});
  Rig rig(model, 3);
  const Serial serial;
  rig.lattice.write(randomState(model, 5e-4, 0.1, 7));
  CpuPd pd(rig.lattice, serial, {200, true, 1.05});  // no spectrum allows 1.05
  rig.run(pd);
  EXPECT_TRUE(pd.gaveUp());
  const std::vector<float> changes = pd.changes();
  for (size_t n = 0; n < kWatched; ++n) EXPECT_GT(changes[n], 0) << "iteration " << n;
}

TEST(CpuLeapfrog, MatchesReferenceAsOneOfTheSteppers) {
  constexpr double kRounding = 1e-5;  // relative to the largest value, after kTimes substeps
  constexpr int kTimes = 10;
  const Serial serial;
  Body body = boxBody({5, 4, 6}, 0.01);
  body.material.dashpot_ratio = 0.1;
  Body rubber = body;
  rubber.material.poisson_ratio = 0.45;
  for (const Body& each : {body, rubber}) {
    const Model model = modelOf({each});
    Rig rig(model, 0.5, Vector3d(0, 0, -9.81));
    rig.lattice.write(randomState(model, 5e-4, 0.1, 7));
    ReferenceSolver reference = rig.reference(ReferenceIntegrator::kLeapfrog);
    const auto stepper = makeCpuStepper(Integrator::kLeapfrog, 1, rig.lattice, rig.with(serial));
    for (int s = 0; s < kTimes; ++s) {
      rig.run(*stepper);
      reference.substep();
    }
    const HostState end = rig.lattice.read();
    EXPECT_LT(relativeError(end.displacement_m, reference.u_m, reference.active), kRounding);
    EXPECT_LT(relativeError(end.velocity_m_per_s, reference.v_m_per_s, reference.active), kRounding);
  }
}

TEST(CpuVerletPaper, MatchesReferenceWithVolumesAndParts) {
  constexpr int kTimes = 10;
  // As for the GPU: four roundings of a position of 0.06 m per substep, each carried on as a velocity.
  constexpr double kRounding_m = 4 * 0.06 / (1 << 24);
  const Serial serial;
  Body body = boxBody({5, 4, 6}, 0.01);
  body.material.drag_per_s = 50;
  Body rubber = body, parts = body;
  rubber.material.poisson_ratio = 0.45;
  parts.parts = {{"box", 60e3, 0.1, 2000}};
  for (const Body& each : {body, rubber, parts}) {
    const Model model = modelOf({each});
    Rig rig(model, 0.5, Vector3d(0, 0, -9.81));
    rig.lattice.write(randomState(model, 5e-4, 0.1, 7));
    ReferenceSolver reference = rig.reference(ReferenceIntegrator::kVerletPaper);
    const auto stepper = makeCpuStepper(Integrator::kVerletPaper, 1, rig.lattice, rig.with(serial));
    for (int s = 0; s < kTimes; ++s) {
      rig.run(*stepper);
      reference.substep();
    }
    const HostState end = rig.lattice.read();
    for (uint32_t slot : reference.active) {
      EXPECT_LT((xyz(end.displacement_m[slot]) - reference.u_m[slot]).norm(), kRounding_m * kTimes * (kTimes + 1) / 2);
      EXPECT_LT((xyz(end.velocity_m_per_s[slot]) - reference.v_m_per_s[slot]).norm(),
                kRounding_m * kTimes / static_cast<double>(rig.step.dt_s));
    }
  }
}

TEST(CpuSteppers, StateHashDoesNotDependOnThreads) {
  const Serial serial;
  const Scattered scattered;
  for (const double poisson_ratio : {0.25, 0.4}) {
    const Model model = rubberBox({16, 5, 7}, poisson_ratio);
    for (const Integrator integrator : {Integrator::kPd, Integrator::kVerletPaper}) {
      EXPECT_EQ(hashAfterTools(integrator, model, scattered), hashAfterTools(integrator, model, serial))
          << static_cast<int>(integrator);
    }
  }
}
