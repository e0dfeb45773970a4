// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// What a backend that lags behind the host, as a GPU does, must not change (src/solver/ticks/tissue_stepper.h).
#include "solver/ticks/tissue_stepper.h"

#include <deque>

#include "solver/cpu/cpu_backend.h"
#include "support/random_state.h"

using namespace viscera;
using namespace viscera::test;

namespace {

constexpr double kTicksSpacing_m = 0.01;

/// Calls until measurements arrive; more than any test makes: only a waiting call receives them.
constexpr int kNever = 1000000;

/// The CPU backend with the monitor's lag of a GPU: measurements arrive some calls after their request.
class LateBackend : public CpuBackend {
 public:
  LateBackend(const Model& model, const Scene& scene, const TickPlan& plan, int checks)
      : CpuBackend(model, scene, plan), checks_(checks) {}

  int waits() const { return waits_; }
  int in_flight() const { return static_cast<int>(in_flight_.size()); }

  int lag() const override { return 1; }

  bool requestStats() override {
    Late late{{}, checks_};
    CpuBackend::requestStats();
    CpuBackend::takeStats(late.stats, true);
    in_flight_.push_back(late);
    return true;
  }

  bool takeStats(layout::TickStats& stats, bool wait) override {
    if (in_flight_.empty()) return false;
    Late& oldest = in_flight_.front();
    if (oldest.checks_left > 0 && !wait) {
      --oldest.checks_left;
      return false;
    }
    waits_ += oldest.checks_left > 0;
    stats = oldest.stats;
    in_flight_.pop_front();
    return true;
  }

 private:
  struct Late {
    layout::TickStats stats;
    int checks_left;
  };
  std::deque<Late> in_flight_;
  int checks_, waits_ = 0;
};

class LateSolver : public TissueStepper {
 public:
  LateSolver(const Model& model, const Scene& scene, const TickPlan& plan, int checks)
      : TissueStepper(model, scene, plan, std::make_unique<LateBackend>(model, scene, plan, checks)) {}

  int waits() const { return late().waits(); }
  int in_flight() const { return late().in_flight(); }

 private:
  const LateBackend& late() const { return static_cast<const LateBackend&>(ticked()); }
};

class LaggingBackend : public ::testing::Test {
 protected:
  /// @param fraction  of the stable substep
  LateSolver make(double fraction, int checks) const {
    Scene scene = sceneWith(Integrator::kLeapfrog, model_, 10, fraction);
    scene.solver.stability_monitor = true;
    scene.solver.threads = 1;
    scene.solver.recovery_s = 5 / scene.solver.tick_hz;
    scene.styluses = {StylusConfig{}};
    SolverOptions options;
    options.allow_unstable = true;
    return LateSolver(model_, scene, planTicks(model_, scene, options), checks);
  }

  static ToolMotions probe() { return probeAt({0.02, 0.02, 0.038}); }

  const Model model_ = modelOf({boxBody({4, 4, 4}, kTicksSpacing_m)});
  const HostState wild_ = randomState(model_, 0.3 * kTicksSpacing_m, 0.1, 5);
};

/// Returns the published measurements of a tick as text.
std::string textOf(const layout::TickStats& stats) {
  return std::to_string(stats.kinetic_j) + ' ' + std::to_string(stats.elastic_j) + ' ' +
         std::to_string(stats.impulse[0].z) + ' ' + std::to_string(stats.max_speed_bits);
}

}  // namespace

TEST_F(LaggingBackend, NoTickIsWaitedForBeforeTheNextOneHasStarted) {
  LateSolver solver = make(0.5, kNever);
  solver.writeState(randomState(model_, 0.05 * kTicksSpacing_m, 0.1, 6));
  const int before = solver.waits();  // writing a state measures it
  for (int t = 0; t < 20; ++t) {
    solver.step(probe());
    EXPECT_EQ(solver.in_flight(), 1) << "tick " << t;
  }
  EXPECT_EQ(solver.waits() - before, 19);  // for each tick but the last
}

TEST_F(LaggingBackend, MeasurementsThatHaveComeAreNotWaitedFor) {
  LateSolver solver = make(0.5, 0);
  for (int t = 0; t < 20; ++t) solver.step(probe());
  EXPECT_EQ(solver.waits(), 0);
}

TEST_F(LaggingBackend, ResultsAreTheSameHoweverLateMeasurementsCome) {
  std::vector<std::string> first;
  for (int checks : {0, 1, 2, kNever}) {
    for (double fraction : {0.5, 10.0}) {  // calm; explodes until the stability monitor recovers it, repeatedly
      SCOPED_TRACE(testing::Message() << checks << " looks, fraction " << fraction);
      LateSolver solver = make(fraction, checks);
      solver.writeState(wild_);
      std::vector<std::string> states, stats;
      layout::TickStats tick;
      for (int t = 0; t < 30; ++t) {
        solver.step(probe());
        while (solver.pollStats(tick, false)) stats.push_back(textOf(tick));
        states.push_back(std::to_string(stateHash(model_, solver.readState())));
      }
      while (solver.pollStats(tick, true)) stats.push_back(textOf(tick));
      ASSERT_EQ(stats.size(), 30u);
      EXPECT_EQ(solver.health().trips > 0, fraction > 1);
      states.insert(states.end(), stats.begin(), stats.end());
      states.push_back(std::to_string(solver.health().trips));
      if (checks == 0) {
        first.insert(first.end(), states.begin(), states.end());
      } else {
        const auto same = first.begin() + (fraction > 1 ? static_cast<std::ptrdiff_t>(states.size()) : 0);
        EXPECT_TRUE(std::equal(states.begin(), states.end(), same));
      }
    }
  }
}

TEST_F(LaggingBackend, RollbackGoesToBeforeTheBadTickAndTheTickAfterItDoesNotCount) {
  LateSolver solver = make(10, kNever);
  solver.writeState(wild_);
  const uint64_t start = stateHash(model_, solver.readState());
  solver.step(probe());
  EXPECT_EQ(solver.health().trips, 0u);
  EXPECT_NE(stateHash(model_, solver.readState()), start);
  solver.step(probe());
  EXPECT_EQ(solver.health().trips, 1u);
  EXPECT_TRUE(solver.health().recovering);
  EXPECT_EQ(stateHash(model_, solver.readState()), start);
  layout::TickStats stats;
  for (int t = 0; t < 2; ++t) {
    ASSERT_TRUE(solver.pollStats(stats, true));
    EXPECT_EQ(stats.nonfinite, 0u);
    EXPECT_NEAR(stats.elastic_j, energyOf(model_, wild_) - stats.kinetic_j, 1e-5 * stats.elastic_j);  // float32 sums
    EXPECT_EQ(xyz(stats.impulse[0]), Vector3d::Zero().eval());
  }
  solver.step(probe());  // pd: good
  solver.step(probe());
  EXPECT_EQ(solver.health().trips, 1u) << "the tick that did not count was judged";
}

TEST_F(LaggingBackend, ResetForgetsTheTickThatIsOpen) {
  LateSolver solver = make(10, kNever);
  solver.writeState(wild_);
  for (int t = 0; t < 3; ++t) solver.step(probe());
  solver.reset();
  EXPECT_EQ(solver.health().trips, 0u);
  layout::TickStats stats;
  EXPECT_FALSE(solver.pollStats(stats, true));
  solver.step({});
  ASSERT_TRUE(solver.pollStats(stats, true));
  EXPECT_EQ(stats.elastic_j, 0);
}

TEST_F(LaggingBackend, MeasurementsAreDeliveredOnce) {
  LateSolver solver = make(0.5, 0);
  layout::TickStats stats;
  for (int t = 0; t < 5; ++t) {
    solver.step(probe());
    EXPECT_TRUE(solver.pollStats(stats, true));
    EXPECT_FALSE(solver.pollStats(stats, true));
  }
  solver.step(probe());
  solver.step(probe());
  EXPECT_TRUE(solver.pollStats(stats, false));
  EXPECT_TRUE(solver.pollStats(stats, false));
  EXPECT_FALSE(solver.pollStats(stats, false));
}
