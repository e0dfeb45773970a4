// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/reference/reference_ticks.h"

#include <algorithm>
#include <utility>

#include "model/fracture/toughness.h"
#include "model/scene/feature_rules.h"
#include "solver/processes/attach/fibres.h"
#include "solver/reference/reference_environment.h"
#include "solver/ticks/registry.h"
#include "solver/ticks/stable_step.h"
#include "solver/tissue/substeps.h"
#include "tools/motion_packing.h"
#include "viscera/math/error.h"
#include "viscera/model/scene/scene.h"

namespace viscera {

namespace {

SolverConfig ungoverned(SolverConfig config) {
  config.stability_monitor = false;
  return config;
}

ReferenceOptions optionsFor(const Model& model, const Scene& scene) {
  const SolverConfig& config = scene.solver;
  ReferenceOptions options;
  options.integrator = traitsOf(config.integrator).truth;
  options.push_speed_m_per_s = static_cast<float>(pushSpeed(model));
  options.sleep_distance_m = static_cast<float>(config.sleep_distance_m);
  for (const Body& body : model.bodies) options.resists.push_back(resistsBlades(body));
  if (environmentOf(model, scene).any()) options.environment = std::make_shared<ReferenceEnvironment>(model, scene);
  return options;
}

}  // namespace

// Substep, gravity and limits are the float32 numbers that the kernels get, so only the arithmetic differs.
ReferenceTicks::ReferenceTicks(const Model& model, const Scene& scene)
    : acts_(scene.styluses, 1 / scene.solver.tick_hz, resistsBlades(scene) && !cutsFreely(scene)),
      tick_hz_(scene.solver.tick_hz),
      dt_safe_s_(stepWith(safeTimeStep(model), attachmentRate(scene, model))),
      substeps_(planSubsteps(model, ungoverned(scene.solver), dt_safe_s_).calm),
      environment_(model, scene),
      solver_(model, scene.environment.gravity_m_per_s2.cast<float>().cast<double>(), static_cast<float>(dt_s()),
              optionsFor(model, scene)),
      processes_(makeProcesses(scene, model, true), 0),
      obstacle_before_n_s_(solver_.obstacle_impulse_n_s) {
  requireReferenceFeatures(scene);
}

void ReferenceTicks::step(const ToolMotions& motions, const ObstacleMotions& obstacles) {
  solver_.markTick();
  obstacle_before_n_s_ = solver_.obstacle_impulse_n_s;
  environment_.beginTick(1 / tick_hz_, substeps_, obstacles);
  acts_.beginTick(solver_, motions);
  interpolateMotions(motions, acts_.styluses(), substeps_, motions_);
  for (layout::ToolMotion& motion : motions_) motion.timing.x = static_cast<float>(dt_s());
  if (std::exchange(first_, false)) {
    for (size_t s = 0; s < layout::kMaxStyluses; ++s) motions_[s].timing.x = 0;
  }
  if (processes_.readCuts() && solver_.springs_cut != cuts_seen_) {
    cuts_seen_ = solver_.springs_cut;
    processes_.cutsChanged(solver_.state());
  }
  const ObstacleMotions& surrounding = environment_.motions().empty() ? obstacles : environment_.motions();
  const ProcessTick tick{motions, surrounding, substeps_, acts_.sever(motions)};
  processes_.beginTick(tick);
  for (int n = 0; n < substeps_; ++n) {
    SubstepMotions substep;
    std::copy_n(motions_.begin() + n * static_cast<int>(layout::kMaxStyluses), layout::kMaxStyluses, substep.begin());
    const SubstepEnvironment now = environment_.at(n);
    SubstepOutside outside{{}, now.wind_m_per_s.cast<double>()};
    outside.obstacles.assign(now.obstacles, now.obstacles + environment_.obstacleCount());
    solver_.substep(substep, outside);
    processes_.act(solver_, tick, {n, dt_s(), substep.data()});
  }
  processes_.endTick(solver_, tick);
  acts_.endTick(solver_, motions);
}

void ReferenceTicks::load(const std::vector<layout::vec4>& u_m, const std::vector<layout::vec4>& v_m_per_s) {
  for (const uint32_t slot : solver_.active) {
    solver_.u_m[slot] = {u_m[slot].x, u_m[slot].y, u_m[slot].z};
    solver_.v_m_per_s[slot] = {v_m_per_s[slot].x, v_m_per_s[slot].y, v_m_per_s[slot].z};
  }
  solver_.restart();
}

Vector3d ReferenceTicks::impulse(uint32_t stylus) const {
  return solver_.tickImpulse(stylus);
}

double ReferenceTicks::maxStretch() const {
  double largest = 0;
  for (uint32_t slot : solver_.active) {
    for (uint32_t s = 0; s < solver_.springsOf(slot); ++s) {
      if (!solver_.isFirstEnd(slot, s) || !solver_.isWhole(slot, s)) continue;
      largest = std::max(largest, std::abs(solver_.strain(solver_.u_m, slot, s)));
    }
  }
  return largest;
}

double ReferenceTicks::maxSpeed_m_per_s() const {
  double largest = 0;
  for (uint32_t slot : solver_.active) largest = std::max(largest, solver_.v_m_per_s[slot].norm());
  return largest;
}

uint64_t ReferenceTicks::nonfinite() const {
  return static_cast<uint64_t>(std::count_if(solver_.active.begin(), solver_.active.end(), [&](uint32_t slot) {
    return !solver_.u_m[slot].allFinite() || !solver_.v_m_per_s[slot].allFinite();
  }));
}

}  // namespace viscera
