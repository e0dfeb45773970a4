// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/multigrid/steps/equilibrium.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "solver/contact/surroundings.h"
#include "solver/cpu/store/thread_pool.h"
#include "solver/multigrid/steps/soft_nodes.h"
#include "solver/multigrid/steps/stage_solver.h"
#include "viscera/math/error.h"
#include "viscera/solver/material.h"

namespace viscera {

namespace {

constexpr int kMostSteps = 80;          // of Newton's method
constexpr int kMostHalvings = 12;       // of one of them
constexpr double kGrows = 1e-6;         // of the energies that are summed: float32 leaves that much
constexpr double kProgress = 0.9;       // of the least residual so far: a step that got somewhere
constexpr int kInexact = 2;             // first steps: far from the end positive tangents do, and never turn back
constexpr int kPatience = 20;           // steps that did not
constexpr int kIterations = 60;         // of a system
constexpr int kIterationsBeside = 120;  // the same with a smoother beside coarse levels
constexpr double kGain = 0.2;           // of them, see Rule
constexpr double kOfEnough = 0.3;       // of what may be left: what a system need not be better than

using multigrid::StageSolver;
using multigrid::Vectors;

double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void requireHeld(const Model& model) {
  for (const Body& body : model.bodies) {
    bool held = false;
    for (const uint32_t slot : body.lattice.active_slots) held = held || isFixed(body.lattice.nodes[slot]);
    if (!held)
      throw SceneError("body '" + body.name + "' is held nowhere: it has no equilibrium. Give it 'fixed' nodes");
    if (body.network)
      throw SceneError("body '" + body.name +
                       "' has explicit connections: equilibria are found of implicit lattices only");
  }
}

/// Newton's method on elastic energy less the work of the load.
class Settling {
 public:
  Settling(StageSolver& solver, SettleReport& report)
      : solver_(solver), soft_(solver), report_(report), increment_(solver.start.size()) {
    for (Vectors* each : {&load_, &trial_}) each->assign(increment_.size(), 0);
    const multigrid::FineLevel& level = solver_.level;
    const size_t n = level.places();
    for (size_t c = 0; c < 3; ++c) {
      for (size_t i = 0; i < n; ++i)
        load_[c * n + i] =
            level.free()[i] * (level.mass()[i] * solver_.gravity[static_cast<int>(c)] + solver_.load[c * n + i]);
    }
  }

  const Vectors& run() {
    const double size = std::sqrt(solver_.level.dot(load_, load_)), enough = kSettled * size;
    if (size == 0 && std::any_of(load_.begin(), load_.end(), [](float n) { return n != 0; }))
      throw Error("no equilibrium was found: squares of so small a load are lost in float32");
    double norm = solver_.residual(increment_);
    const auto start = std::chrono::steady_clock::now();
    for (int step = 0; step < kMostSteps; ++step) {
      report_.residual = size > 0 ? norm / size : 0;
      report_.settled =
          report_.residual <= kSettled || (report_.last_change <= kSettled && report_.residual <= kMostLeft);
      if (report_.settled || stale_ > kPatience) break;
      const double before = norm;
      norm = improve(norm, enough);
      if (report_.newton > kInexact) {
        soft_.learn(before, norm);
        if (norm > enough && soft_.relax(increment_, norm, enough)) norm = solver_.residual(increment_);
      }
      stale_ = norm < kProgress * best_ ? 0 : stale_ + 1;
      best_ = std::min(best_, norm);
    }
    report_.seconds = secondsSince(start);
    return increment_;
  }

 private:
  double potential(const Vectors& u) const { return solver_.elastic_j - solver_.level.dot(load_, u); }

  /// A Newton step, as long as the energy does not grow. @return norm of the residual after it
  double improve(double norm, double enough) {
    multigrid::Rule rule;
    rule.side_by_side = !soft_.any();  // slivers ask for more of a smoother
    rule.most = rule.side_by_side ? kIterationsBeside : kIterations;
    rule.tolerance = 0;
    rule.gain = kGain;
    rule.enough_n = kOfEnough * enough;
    rule.stiffening = &soft_;
    rule.exact = report_.newton >= kInexact;
    const double before_j = potential(increment_),
                 allowed_j = before_j + kGrows * (std::abs(before_j) + solver_.elastic_j);
    const int iterations = solver_.solveLinear(increment_, rule, norm);
    report_.iterations += iterations;
    ++report_.newton;
    float share = 1;
    for (int halving = 0; halving <= kMostHalvings; ++halving, share /= 2) {
      for (size_t i = 0; i < trial_.size(); ++i) trial_[i] = increment_[i] + share * solver_.solution()[i];
      const double left = solver_.residual(trial_);
      if (!(potential(trial_) <= allowed_j)) continue;
      const double size2 = solver_.level.dot(trial_, trial_);
      const double change2 = solver_.level.dot(solver_.solution(), solver_.solution());
      // What no iteration has solved for says nothing of what is left.
      if (halving == 0 && iterations > 0 && change2 > 0 && size2 > 0) report_.last_change = std::sqrt(change2 / size2);
      if (halving > 0) soft_.sagged();
      std::swap(trial_, increment_);
      return left;
    }
    throw Error("no equilibrium was found: the energy falls in no direction that was tried");
  }

  StageSolver& solver_;
  multigrid::SoftNodes soft_;
  SettleReport& report_;
  Vectors increment_, load_, trial_;
  double best_ = std::numeric_limits<double>::infinity();  ///< norm of a residual
  int stale_ = 0;                                          ///< steps since it fell
};

}  // namespace

HostState equilibriumOf(const Model& model, const Scene& scene, SettleReport& report,
                        const std::shared_ptr<ThreadPool>& threads) {
  requireHeld(model);
  report = {};
  const CpuLattice lattice(model, bodyParams(model, safeTimeStep(model)), featuresOf(model, scene, 1));
  const std::shared_ptr<ThreadPool> pool = threads ? threads : makeThreadPool(scene.solver.threads);
  const auto start = std::chrono::steady_clock::now();
  StageSolver solver(model, lattice, *pool);
  solver.gravity = scene.environment.gravity_m_per_s2.cast<float>();
  const std::vector<layout::vec4> pushes = bodyInfluences(model, scene);
  const multigrid::Grid& grid = solver.level.grid();
  const size_t n = grid.places();
  for (uint32_t node = 0; node < grid.nodeCount(); ++node) {
    const layout::vec4& a = pushes[grid.bodyOf(node)];
    const uint32_t place = grid.place_of[node];
    for (size_t c = 0; c < 3; ++c) solver.load[c * n + place] = solver.level.mass()[place] * (&a.x)[c];
  }
  solver.begin({});
  report.build_s = secondsSince(start);
  const multigrid::FineWork before = solver.level.work();
  const Vectors u = Settling(solver, report).run();
  report.forces = solver.level.work().forces - before.forces;
  report.products = solver.level.work().products - before.products;
  HostState state = lattice.read();
  for (uint32_t node = 0; node < grid.nodeCount(); ++node) {
    const uint32_t place = grid.place_of[node];
    const Vector3f at(u[place], u[n + place], u[2 * n + place]);
    state.displacement_m[grid.slots[node]] = {at.x(), at.y(), at.z(), 0};
    report.largest_m = std::max(report.largest_m, static_cast<double>(at.norm()));
  }
  if (!(report.residual < 1)) throw Error("no equilibrium was found");
  return state;
}

}  // namespace viscera
