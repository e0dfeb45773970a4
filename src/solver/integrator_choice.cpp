// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/integrator_choice.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <optional>
#include <vector>

#include "model/scene/integrators.h"
#include "solver/cpu/cpu_solver.h"
#include "viscera/math/error.h"

namespace viscera {

namespace {

using Clock = std::chrono::steady_clock;

constexpr int kTicks = 8;              // of each: the first ones of a fall, in which multigrid has most to solve
constexpr double kLongEnough_s = 1.5;  // of wall time, when some ticks are done
constexpr size_t kFewest = 3;          // ticks, whatever they take
constexpr double kMustGain = 0.9;      // of leapfrog's time: at less gain its smaller error decides

/// A solver whose ticks are timed.
class Trial {
 public:
  Trial(const Model& model, Scene scene, Integrator integrator, const std::shared_ptr<ThreadPool>& threads) {
    scene.solver.integrator = integrator;
    if (scene.environment.gravity_m_per_s2.isZero()) scene.environment.gravity_m_per_s2 = {0, 0, -9.81};
    CpuSolverOptions options;
    options.threads = threads;
    solver_ = std::make_unique<CpuSolver>(model, scene, options);
  }
  void step() {
    const Clock::time_point start = Clock::now();
    solver_->step({});
    taken_s_.push_back(std::chrono::duration<double>(Clock::now() - start).count());
  }
  double middle_s() {
    std::nth_element(taken_s_.begin(), taken_s_.begin() + static_cast<std::ptrdiff_t>(taken_s_.size() / 2),
                     taken_s_.end());
    return taken_s_[taken_s_.size() / 2];
  }
  size_t ticks() const { return taken_s_.size(); }

 private:
  std::unique_ptr<Ticks> solver_;
  std::vector<double> taken_s_;
};

/// Why multigrid has no steps for the scene; empty: it has.
std::string missing(const Model& model, const Scene& scene, Backend backend) {
  if (backend != Backend::kCpu) return "the GPU backend has no multigrid";
  if (model.hasNetwork()) return "multigrid steps implicit lattices, not bodies with explicit connections";
  if (scene.collision.enabled) return "multigrid knows no contacts between nodes";
  return "";
}

std::string compared(const char* chosen, double multigrid_s, double leapfrog_s) {
  constexpr double kMilli = 1e3;
  char text[160];
  std::snprintf(text, sizeof(text), "%s, as a tick takes %.3g ms with multigrid, %.3g ms with leapfrog", chosen,
                kMilli * multigrid_s, kMilli * leapfrog_s);
  return text;
}

}  // namespace

IntegratorChoice chooseIntegrator(const Model& model, const Scene& scene, Backend backend,
                                  const std::shared_ptr<ThreadPool>& threads) {
  const std::string why_not = missing(model, scene, backend);
  if (!why_not.empty()) return {Integrator::kLeapfrog, "leapfrog, as " + why_not};
  std::optional<Trial> leapfrog;
  try {
    leapfrog.emplace(model, scene, Integrator::kLeapfrog, threads);
  } catch (const SceneError& error) {  // too many substeps, or given ones that are too long
    return {Integrator::kMultigrid, std::string("multigrid, as leapfrog cannot step this: ") + error.what()};
  }
  Trial multigrid(model, scene, Integrator::kMultigrid, threads);
  const Clock::time_point start = Clock::now();
  while (leapfrog->ticks() < kTicks) {
    leapfrog->step();
    multigrid.step();
    const double so_far_s = std::chrono::duration<double>(Clock::now() - start).count();
    if (leapfrog->ticks() >= kFewest && so_far_s > kLongEnough_s) break;
  }
  const double implicit_s = multigrid.middle_s(), explicit_s = leapfrog->middle_s();
  if (implicit_s < kMustGain * explicit_s)
    return {Integrator::kMultigrid, compared("multigrid", implicit_s, explicit_s)};
  return {Integrator::kLeapfrog, compared("leapfrog", implicit_s, explicit_s)};
}

}  // namespace viscera
