// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/cpu_multigrid.h"

#include <cmath>

#include "math/archive.h"
#include "solver/cpu/text/glsl_kernel.h"
#include "solver/multigrid/steps/step_rules.h"

namespace viscera {

namespace glsl {

namespace {

#define VARIANT_NAME Fragments
#define VARIANT_BASE Kernel
#define VARIANT_TEXT "shaders/solver/tissue/sleep.glsl"
#include "solver/cpu/text/glsl_variant.inc"

}  // namespace

}  // namespace glsl

namespace {

const Model& steppable(const Model& model, const CpuParts& parts) {
  multigrid::requireSteppable(model, parts.pairs != nullptr);
  return model;
}

}  // namespace

CpuMultigrid::CpuMultigrid(const Model& model, const CpuLattice& lattice, const CpuParts& parts)
    : stages_(steppable(model, parts), lattice, parts.parallel),
      solver_(stages_.solver),
      touching_(solver_.level, lattice),
      left_(solver_.start.size(), 0) {
  solver_.begin(multigrid::trBdf2Stage(parts.dt_s));
}

void CpuMultigrid::restart() {
  fresh_ = true;
  touching_.restart();
}

void CpuMultigrid::persist(Archive& archive, CpuLattice& lattice) {
  archive.values(left_);
  archive.value(fresh_);
  archive.value(work_);
  archive.value(springs_changed_);
  archive.value(steps_since_cut_);
  touching_.persist(archive);
  solver_.persist(archive, lattice);
}

void CpuMultigrid::run(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions) {
  if (springs_changed_) {
    solver_.refresh();
    springs_changed_ = false;
    solver_.takeRebuilt();  // of springs before this cut: better than that from before all of them
    steps_since_cut_ = 0;
  }
  gather(lattice, step.dt_s);
  multigrid::Touching* const touching = step.tools || step.obstacle_count > 0 ? &touching_ : nullptr;
  if (touching) touching->begin(lattice, step, motions);
  stages_.beginStep(step, touching);
  const double dt_s = static_cast<double>(step.dt_s);
  if (!multigrid::stepTrBdf2(stages_, dt_s, work_)) {
    if (touching) touching->begin(lattice, step, motions);
    multigrid::stepEuler(stages_, dt_s, work_);
  }
  if (touching) touching->give(lattice, stages_.increment, stages_.before, solver_.velocity);
  scatter(lattice, step);
  followSprings();
}

/// When cutting has ended, the hierarchy is rebuilt beside some steps. Which they are does not depend on how long
/// that takes, so that results are the same on any machine.
void CpuMultigrid::followSprings() {
  if (steps_since_cut_ < 0) return;
  ++steps_since_cut_;
  if (steps_since_cut_ == multigrid::kStepsToRebuild) solver_.rebuildAside();
  if (steps_since_cut_ < multigrid::kStepsToRebuild + multigrid::kStepsToBuild) return;
  solver_.takeRebuilt();
  steps_since_cut_ = -1;
}

/// What has changed velocities since the last step is a force over this one: what pushes the tissue in every step would
/// otherwise throw what is stiffer than a step can follow back and forth rather than hold it.
void CpuMultigrid::gather(const CpuLattice& lattice, float dt_s) {
  const multigrid::Grid& grid = solver_.level.grid();
  const size_t n = grid.places();
  const float* u = lattice.state.displacement[lattice.state.current].data();
  const float* v = lattice.state.velocity[lattice.state.current].data();
  for (uint32_t node = 0; node < grid.nodeCount(); ++node) {
    const uint32_t place = grid.place_of[node];
    for (size_t c = 0; c < 3; ++c) {
      const size_t to = c * n + place, from = vectorAt(grid.slots[node]) + 64 * c;
      solver_.start[to] = u[from];
      stages_.before[to] = fresh_ ? v[from] : left_[to];
      solver_.load[to] = solver_.level.mass()[place] * (v[from] - stages_.before[to]) / dt_s;
    }
  }
  fresh_ = false;
}

void CpuMultigrid::scatter(CpuLattice& lattice, const Substep& step) {
  const multigrid::Grid& grid = solver_.level.grid();
  const size_t n = grid.places();
  float* const u = lattice.state.displacement[1 - lattice.state.current].data();
  float* const v = lattice.state.velocity[1 - lattice.state.current].data();
  const auto at = [n](const multigrid::Vectors& x, size_t place) {
    return glsl::vec3(x[place], x[n + place], x[2 * n + place]);
  };
  glsl::Fragments fragments(lattice);
  fragments.tell(step);
  for (uint32_t node = 0; node < grid.nodeCount(); ++node) {
    const uint32_t place = grid.place_of[node], slot = grid.slots[node];
    const glsl::vec3 before = at(solver_.start, place);
    glsl::vec3 next = before, speed(0);
    if (solver_.level.movable()[place] != 0) {
      next += at(stages_.increment, place);
      speed = at(solver_.velocity, place);
      fragments.fallAsleep(lattice.store.nodes[slot], before, next, speed);
    }
    setPlanes(u, slot, {next.x, next.y, next.z});
    setPlanes(v, slot, {speed.x, speed.y, speed.z});
    for (size_t c = 0; c < 3; ++c) left_[c * n + place] = speed[static_cast<int>(c)];
  }
}

}  // namespace viscera
