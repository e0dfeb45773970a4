// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// PdPass by itself, and what only the GPU has; the rest is in solver/pd_gl_test.cpp.
#include "solver/gpu/pd_pass.h"

#include "support/implicit.h"

using namespace viscera;
using namespace viscera::test;

namespace {

/// One substep of a pass by itself.
class PdAlone {
 public:
  PdAlone(const Model& model, const HostState& start, double fraction)
      : dt_safe_s_(safeTimeStep(model)),
        features_(featuresOf(model, Scene{}, dt_safe_s_, layout::kGroupSize)),
        buffers_(model, {bodyParams(model.bodies[0], dt_safe_s_)}, features_),
        start_(start) {
    step_.dt_s = static_cast<float>(fraction * dt_safe_s_);
  }
  std::unique_ptr<PdPass> pass(const PdOptions& options) {
    return std::make_unique<PdPass>(features_, buffers_, options);
  }
  /// From the start.
  HostState run(Stepper& pass) {
    buffers_.state.displacement[buffers_.state.current].write(start_.displacement_m);
    buffers_.state.velocity[buffers_.state.current].write(start_.velocity_m_per_s);
    buffers_.bind();
    pass.run(buffers_, step_);
    buffers_.swap();
    return {buffers_.state.displacement[buffers_.state.current].read(),
            buffers_.state.velocity[buffers_.state.current].read(),
            buffers_.store.nodes.read(),
            {}};
  }
  float dt_s() const { return step_.dt_s; }
  const LatticeBuffers& buffers() const { return buffers_; }
  const FeatureSet& features() const { return features_; }

 private:
  double dt_safe_s_;
  FeatureSet features_;
  LatticeBuffers buffers_;
  HostState start_;
  Substep step_;
};

}  // namespace

using PdOnGpu = GpuTest;

TEST_F(PdOnGpu, RecoveryKeepsTheEnergyBound) {
  for (const double poisson_ratio : {0.25, 0.45}) {
    Body body = boxBody({3, 3, 3}, 0.01);
    body.material.poisson_ratio = poisson_ratio;
    const Model model = modelOf({body});
    for (const double fraction : {1.0, 10.0, 100.0}) {
      for (const Abuse abuse : kAbuses) {
        SCOPED_TRACE(::testing::Message() << poisson_ratio << " " << fraction << " " << static_cast<int>(abuse));
        PdAlone alone(model, abusedState(model, abuse), fraction);
        const auto recovery = makeRecoveryStepper(20, alone.features(), alone.buffers());
        const double start_j = energyOf(model, abusedState(model, abuse));
        const HostState end = alone.run(*recovery);
        EXPECT_TRUE(isFinite(end.displacement_m) && isFinite(end.velocity_m_per_s));
        EXPECT_LE(energyOf(model, end), start_j + 0.01 * std::abs(start_j) + 1e-9);
      }
    }
  }
}

TEST_F(PdOnGpu, AccelerationReachesAnErrorInFewerIterations) {
  const Model model = modelOf({boxBody({5, 5, 5}, 0.01)});
  PdAlone alone(model, randomState(model, 5e-4, 0.1, 7), 5);
  const auto sweepsUntil = [&](bool accelerated) {
    const auto pass = alone.pass({400, accelerated});
    alone.run(*pass);
    EXPECT_FALSE(pass->gaveUp());
    const std::vector<float> changes = pass->changes();
    size_t last = changes.size();
    while (last > 0 && changes[last - 1] < 1e-4f * changes[0]) --last;
    return last;
  };
  const size_t plain = sweepsUntil(false), accelerated = sweepsUntil(true);
  EXPECT_LT(plain, 400u);
  EXPECT_LT(2 * accelerated, plain) << accelerated << " against " << plain;
}

TEST_F(PdOnGpu, SpectralRadiusIsThatOfTheLatticesStiffestNode) {
  Body body = boxBody({4, 4, 4}, 0.01);
  body.material.dashpot_ratio = 0;
  const Model model = modelOf({body});
  PdAlone alone(model, restState(model), 3);
  const auto pass = alone.pass({1, true});
  // dt_safe^2 = 2 / max(sum of k / m), so m/dt^2 is (2 / fraction^2) / 2 of sum of k there.
  const double sum_over_inertia = 2 * 3.0 * 3.0;
  EXPECT_NEAR(pass->spectralRadius(alone.dt_s()), sum_over_inertia / (1 + sum_over_inertia), 1e-6);  // float32 rates
}

TEST_F(PdOnGpu, AccelerationThatGoesWrongIsGivenUpAndStartsAgain) {
  const Model model = modelOf({boxBody({4, 4, 4}, 0.01)});
  const HostState start = randomState(model, 5e-4, 0.1, 7);
  PdAlone alone(model, start, 3);
  const auto wrong = alone.pass({200, true, 1.05});  // beyond 1: weights that no spectrum allows
  const HostState end = alone.run(*wrong);
  EXPECT_TRUE(wrong->gaveUp());
  const auto plain = alone.pass({200, false});
  const HostState plain_end = alone.run(*plain);
  EXPECT_FALSE(plain->gaveUp());
  double difference_m = 0;
  for (uint32_t slot : model.bodies[0].lattice.active_slots) {
    difference_m = std::max(difference_m, (xyz(end.displacement_m[slot]) - xyz(plain_end.displacement_m[slot])).norm());
  }
  EXPECT_LT(difference_m, 1e-3 * 5e-4);  // it lost the few sweeps before it gave up, no more
}

TEST_F(PdOnGpu, StateHashDoesNotDependOnGroupSize) {
  expectSameHashForEveryGroupSize(Integrator::kPd);
}
