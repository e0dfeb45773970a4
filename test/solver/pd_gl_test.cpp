// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/state/cpu_stepper.h"
#include "solver/cpu/steps/cpu_device.h"
#include "solver/device/pd.h"
#include "solver/gpu/steps/gpu_device.h"
#include "support/features.h"
#include "support/implicit.h"

using namespace viscera;
using namespace viscera::test;

namespace {

// Relative to the largest value, after kSubsteps of 3 dt_safe with enough iterations to converge: float32 rounding of
// increments and of their sum.
constexpr double kPdConverged = 2e-6;
constexpr int kPdIterations = 160;
constexpr int kPdSubsteps = 3;

class Pd : public OnBackend {
 protected:
  void expectLikeReference(const Model& model, const Vector3d& gravity) {
    const auto solver = make(model, sceneWith(Integrator::kPd, model, kPdSubsteps, 3, kPdIterations, {}, gravity));
    const HostState start = randomState(model, 0.05 * model.bodies[0].lattice.spacing_m, 0.1, 7);
    ReferenceSolver reference = referenceFor(ReferenceIntegrator::kImplicitEuler, model, *solver, start, gravity);
    expectSameTick(*solver, reference, start, kPdConverged, kPdConverged);
  }
};

/// The iteration alone, without a solver around it.
class PdAlone {
 public:
  struct Run {
    HostState end;
    std::vector<float> changes;  ///< as in PdStepper
    bool gave_up;
  };
  virtual ~PdAlone() = default;
  /// Makes one substep from a state.
  virtual Run run(const HostState& start, const PdOptions& options) = 0;
  /// Makes the stability monitor's recovery from a state. @return states after each substep
  virtual std::vector<HostState> recover(const HostState& start, int iterations, int substeps) = 0;
  virtual double spectralRadius() = 0;

 protected:
  PdAlone(const Model& model, double fraction) {
    step_.dt_s = static_cast<float>(fraction * safeTimeStep(model));
    step_.sleep_distance_m = 1e6;
    step_.push_speed_m_per_s = static_cast<float>(pushSpeed(model));
  }
  Substep step_;
};

class PdAloneOnCpu : public PdAlone {
 public:
  PdAloneOnCpu(const Model& model, double fraction)
      : PdAlone(model, fraction), lattice_(model, bodyParams(model, safeTimeStep(model)), featuresFor(model, true)) {}
  Run run(const HostState& start, const PdOptions& options) override {
    lattice_.write(start);
    PdStepper<CpuDevice> pd({lattice_, serial_}, options);
    HostState end = substep(pd);
    return {std::move(end), pd.changes(), pd.gaveUp()};
  }
  std::vector<HostState> recover(const HostState& start, int iterations, int substeps) override {
    const auto stepper = makeCpuRecoveryStepper(iterations, lattice_, serial_);
    lattice_.write(start);
    std::vector<HostState> out;
    for (int s = 0; s < substeps; ++s) out.push_back(substep(*stepper));
    return out;
  }
  double spectralRadius() override {
    return PdStepper<CpuDevice>({lattice_, serial_}, {1}).spectralRadius(static_cast<double>(step_.dt_s));
  }

 private:
  HostState substep(CpuStepper& stepper) {
    stepper.run(lattice_, step_, nullptr);
    lattice_.swap();
    return lattice_.read();
  }
  CpuLattice lattice_;
  const Serial serial_;
};

class PdAloneOnGpu : public PdAlone {
 public:
  PdAloneOnGpu(const Model& model, double fraction)
      : PdAlone(model, fraction),
        features_(featuresOf(model, Scene{}, safeTimeStep(model), layout::kGroupSize)),
        buffers_(model, {bodyParams(model.bodies[0], safeTimeStep(model))}, features_) {}
  Run run(const HostState& start, const PdOptions& options) override {
    PdStepper<GpuDevice> pass({features_, buffers_}, options);
    write(start);
    HostState end = substep(pass);
    return {std::move(end), pass.changes(), pass.gaveUp()};
  }
  std::vector<HostState> recover(const HostState& start, int iterations, int substeps) override {
    const auto stepper = makeRecoveryStepper(iterations, features_, buffers_);
    write(start);
    std::vector<HostState> out;
    for (int s = 0; s < substeps; ++s) out.push_back(substep(*stepper));
    return out;
  }
  double spectralRadius() override {
    return PdStepper<GpuDevice>({features_, buffers_}, {1, true}).spectralRadius(static_cast<double>(step_.dt_s));
  }

 private:
  void write(const HostState& start) {
    buffers_.state.displacement[buffers_.state.current].write(start.displacement_m);
    buffers_.state.velocity[buffers_.state.current].write(start.velocity_m_per_s);
  }
  HostState substep(Stepper& stepper) {
    buffers_.bind();
    stepper.run(buffers_, step_);
    buffers_.swap();
    return {{buffers_.store.nodes.read(), {}, {}},
            buffers_.state.displacement[buffers_.state.current].read(),
            buffers_.state.velocity[buffers_.state.current].read()};
  }
  FeatureSet features_;
  LatticeBuffers buffers_;
};

std::unique_ptr<PdAlone> pdAlone(const std::string& backend, const Model& model, double fraction) {
  if (backend == "gpu") return std::make_unique<PdAloneOnGpu>(model, fraction);
  return std::make_unique<PdAloneOnCpu>(model, fraction);
}

INSTANTIATE_TEST_SUITE_P(Backends, Pd, ::testing::ValuesIn(backendKinds()), backendSuffix);

}  // namespace

TEST_P(Pd, MatchesReferenceAtEverySize) {
  for (size_t size : kSizes) {
    if (size > 100)
      continue;  // a random tree of 1234 nodes is connected by single springs: it would take thousands of iterations
    SCOPED_TRACE(size);
    Body body = blobBody(size, 0.01, 3);
    body.material.mass_damping_per_s = 50;
    expectLikeReference(modelOf({body}), Vector3d(0.3, -0.2, -9.81));
  }
}

TEST_P(Pd, MatchesReferenceOfABlock) {
  expectLikeReference(modelOf({boxBody({4, 4, 4}, 0.01)}), Vector3d(0, 0, -9.81));
}

TEST_P(Pd, MatchesReferenceWithPartsAndFixedNodes) {
  expectLikeReference(modelOf({twoPartBody()}), Vector3d(0, 0, -9.81));
}

TEST_P(Pd, EnergyStaysBelowItsStartWhateverTheStart) {
  for (const double fraction : {0.5, 1.0, 10.0, 100.0}) expectEnergyBound(GetParam(), Integrator::kPd, fraction);
}

/// One sweep is far from a solution: its velocities have more energy than the start, and are rejected.
TEST_P(Pd, EnergyStaysBelowItsStartWithTooFewIterations) {
  expectEnergyBound(GetParam(), Integrator::kPd, 0.2, 1);
}

TEST_P(Pd, FallsFreelyHoweverLongTheSubstep) {
  const Model model = modelOf({boxBody({3, 3, 3}, 0.01)});
  const auto solver = make(model, sceneWith(Integrator::kPd, model, 4, 30, 5, {}, Vector3d(0, 0, -9.81)));
  ReferenceSolver reference =
      referenceFor(ReferenceIntegrator::kImplicitEuler, model, *solver, restState(model), Vector3d(0, 0, -9.81));
  solver->step({});
  for (int s = 0; s < 4; ++s) reference.substep();
  EXPECT_LT(relativeError(solver->readState().displacement_m, reference.u_m, reference.active), kPdConverged);
}

TEST_P(Pd, ToolsActLikeTheReferences) {
  // Absolute positions of tools, rounded at 6e-8 of 0.05 m, on displacements of 3e-3 m.
  expectToolsLikeReference(GetParam(), Integrator::kPd, kPdIterations, 1e-5);
}

TEST_P(Pd, RecoveryKeepsTheEnergyBound) {
  constexpr int kIterationsOfRecovery = 20, kRecovered = 8;  // substeps
  constexpr double kAllowed = 0.01;                          // of the start: the stability suite's limit
  constexpr double kNothing_j = 1e-9;                        // as in expectEnergyBound()
  Body body = boxBody({3, 3, 3}, 0.01);
  body.material.mass_damping_per_s = 0;
  const Model model = modelOf({body});
  for (const double fraction : {1.0, 10.0, 100.0}) {
    const auto alone = pdAlone(GetParam(), model, fraction);
    for (const Abuse abuse : kAbuses) {
      SCOPED_TRACE(::testing::Message() << fraction << " " << static_cast<int>(abuse));
      const double start_j = energyOf(model, abusedState(model, abuse));
      for (const HostState& end : alone->recover(abusedState(model, abuse), kIterationsOfRecovery, kRecovered)) {
        ASSERT_TRUE(isFinite(end));
        ASSERT_LE(energyOf(model, end), start_j + kAllowed * std::abs(start_j) + kNothing_j);
      }
    }
  }
}

TEST_P(Pd, AccelerationReachesAnErrorInFewerIterations) {
  const Model model = modelOf({boxBody({5, 5, 5}, 0.01)});
  const auto alone = pdAlone(GetParam(), model, 5);
  const auto sweepsUntil = [&](bool accelerated) {
    const PdAlone::Run run = alone->run(randomState(model, 5e-4, 0.1, 7), {400, accelerated});
    EXPECT_FALSE(run.gave_up);
    size_t last = run.changes.size();
    while (last > 0 && run.changes[last - 1] < 1e-4f * run.changes[0]) --last;
    return last;
  };
  const size_t plain = sweepsUntil(false), accelerated = sweepsUntil(true);
  EXPECT_LT(plain, 400u);
  EXPECT_LT(2 * accelerated, plain) << accelerated << " against " << plain;
}

TEST_P(Pd, SpectralRadiusIsThatOfTheLatticesStiffestNode) {
  Body body = boxBody({4, 4, 4}, 0.01);
  body.material.stiffness_damping_ratio = 0;
  const Model model = modelOf({body});
  // dt_safe^2 = 2 / max(sum of k / m), so m/dt^2 is (2 / fraction^2) / 2 of the sum of k there.
  const double sum_over_inertia = 2 * 3.0 * 3.0;
  EXPECT_NEAR(pdAlone(GetParam(), model, 3)->spectralRadius(), sum_over_inertia / (1 + sum_over_inertia),
              1e-6);  // float32 rates
}

TEST_P(Pd, DivergingAccelerationIsAbandonedAndRestarts) {
  const Model model = modelOf({boxBody({4, 4, 4}, 0.01)});
  const HostState start = randomState(model, 5e-4, 0.1, 7);
  const auto alone = pdAlone(GetParam(), model, 3);
  const PdAlone::Run wrong = alone->run(start, {200, true, 1.05});  // beyond 1: weights that no spectrum permits
  const PdAlone::Run plain = alone->run(start, {200, false});
  EXPECT_TRUE(wrong.gave_up);
  EXPECT_FALSE(plain.gave_up);
  for (uint32_t slot : model.bodies[0].lattice.active_slots) {  // it lost only the few sweeps before it was abandoned
    EXPECT_LT((xyz(wrong.end.displacement_m[slot]) - xyz(plain.end.displacement_m[slot])).norm(), 1e-3 * 5e-4);
  }
}

/// The recorded change of the abandoned iteration must not be zero.
TEST_P(Pd, RestartsWhereTheFirstNodeIsFixed) {
  constexpr size_t kWatched = 20;  // iterations; an early one is abandoned
  Body body = boxBody({4, 4, 4}, 0.01);
  body.lattice.nodes[body.lattice.active_slots[0]].lo |= layout::kFixedBit;
  const Model model = modelOf({body});
  const PdAlone::Run run =
      pdAlone(GetParam(), model, 3)->run(randomState(model, 5e-4, 0.1, 7), {200, true, 1.05});  // no spectrum's
  EXPECT_TRUE(run.gave_up);
  for (size_t n = 0; n < kWatched; ++n) EXPECT_GT(run.changes[n], 0) << "iteration " << n;
}
