// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/steps/multigrid_pass.h"

#include <cstring>

#include "math/archive.h"
#include "solver/cpu/store/thread_pool.h"
#include "solver/multigrid/steps/step_rules.h"
#include "viscera/solver/material.h"

namespace viscera {

namespace {

/// What levels are built of, without what touches nodes.
FeatureSet withoutTools(FeatureSet features) {
  features.tools = features.cuts = false;
  features.obstacles = 0;
  return features;
}

const Model& steppable(const Model& model, const Scene& scene) {
  multigrid::requireSteppable(model, scene.collision.enabled);
  return model;
}

bool same(const std::vector<layout::NodeBits>& a, const std::vector<layout::NodeBits>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]) == 0;
}

}  // namespace

MultigridPass::MultigridPass(const Model& model, const Scene& scene, const TickPlan& plan, const FeatureSet& features,
                             const LatticeBuffers& buffers)
    : lattice_(steppable(model, scene), bodyParams(model, plan.dt_safe_s), withoutTools(features)),
      threads_(makeThreadPool(scene.solver.threads)),
      level_(model, lattice_, *threads_),
      stages_(features, buffers) {
  if (features.tools || features.obstacles > 0) touch_.emplace(features, buffers);
  stages_.setLevels([this](const multigrid::Stage& stage) { return levelsFor(stage); }, level_.stiffest());
  levelsFor(multigrid::trBdf2Stage(plan.shortestSubstep_s()));
}

MultigridStages::Levels MultigridPass::levelsFor(const multigrid::Stage& stage) {
  const multigrid::BuiltLevels::Built& built = built_.of(level_, stage);
  const auto found = levels_.try_emplace(built.hierarchy.get(), *built.hierarchy, level_.grid().slots).first;
  return {&found->second, built.largest};
}

void MultigridPass::takeRebuilt() {
  if (built_.takeRebuilt()) levels_.clear();
}

void MultigridPass::persist(Archive& archive) {
  archive.value(touched_);
  archive.value(fresh_);
  archive.value(work_);
  archive.value(springs_changed_);
  archive.value(steps_since_cut_);
  stages_.persist(archive);
  if (touch_) touch_->persist(archive);
  built_.persist(archive, level_, lattice_);
  if (archive.reads()) levels_.clear();
}

void MultigridPass::run(LatticeBuffers& buffers, const Substep& step) {
  if (springs_changed_) {
    springs_changed_ = false;
    takeRebuilt();  // of springs before this cut: better than that from before all of them
    steps_since_cut_ = 0;
  }
  stages_.bind();
  const bool touching = touch_ && MultigridTouchPass::isAbout(step);
  if (fresh_ || (touched_ && !touching)) stages_.forgetTouched();  // what pressed is unknown
  touched_ = touching;
  stages_.beginStep(step, fresh_, touching ? &*touch_ : nullptr);
  fresh_ = false;
  const double dt_s = static_cast<double>(step.dt_s);
  if (touching) touch_->begin(buffers, step);
  if (!multigrid::stepTrBdf2(stages_, dt_s, work_)) {
    if (touching) touch_->begin(buffers, step);
    multigrid::stepEuler(stages_, dt_s, work_);
  }
  if (touching) touch_->give(buffers, step);
  stages_.endStep();
  followSprings(buffers);
}

/// When cutting has ended, the levels are rebuilt beside some steps, as on the CPU.
void MultigridPass::followSprings(const LatticeBuffers& buffers) {
  if (steps_since_cut_ < 0) return;
  ++steps_since_cut_;
  if (steps_since_cut_ == multigrid::kStepsToRebuild) {
    std::vector<layout::NodeBits> nodes = buffers.store.nodes.read();
    if (same(nodes, lattice_.store.nodes)) {
      steps_since_cut_ = -1;
      return;
    }
    lattice_.store.nodes = std::move(nodes);
    lattice_.strengths.refreshAll(lattice_.store);
    level_.refresh();
    built_.rebuildAside(level_);
  }
  if (steps_since_cut_ < multigrid::kStepsToRebuild + multigrid::kStepsToBuild) return;
  takeRebuilt();
  steps_since_cut_ = -1;
}

}  // namespace viscera
