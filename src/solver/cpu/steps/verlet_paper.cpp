// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/steps/verlet_paper.h"

#include "math/archive.h"

namespace viscera {

namespace glsl {

namespace {

struct PositionKernel : Kernel {
  using Kernel::Kernel;
  const vec4* positions = nullptr;
  vec4 *rebuilt_positions = nullptr, *positions_before = nullptr;
};

#define VARIANT_NAME Rebuild
#define VARIANT_BASE PositionKernel
#define VARIANT_TEXT "shaders/solver/step/verlet_paper.comp"
#define VARIANT_FEATURES WITH_REBUILD
#include "solver/cpu/kernels/glsl_variant.inc"

#define VARIANT_NAME Advance
#define VARIANT_BASE PositionKernel
#define VARIANT_TEXT "shaders/solver/step/verlet_paper.comp"
#include "solver/cpu/kernels/glsl_variant.inc"

#define VARIANT_NAME AdvanceWithTools
#define VARIANT_BASE PositionKernel
#define VARIANT_TEXT "shaders/solver/step/verlet_paper.comp"
#define VARIANT_FEATURES WITH_TOOLS
#include "solver/cpu/kernels/glsl_variant.inc"

}  // namespace

}  // namespace glsl

CpuVerletPaper::CpuVerletPaper(const CpuLattice& lattice, const Parallel& parallel) : parallel_(parallel) {
  for (auto& positions : positions_) positions.assign(lattice.slotCount(), glsl::vec4(0));
}

template <class Kernel>
Kernel CpuVerletPaper::kernel(CpuLattice& lattice, const Substep& step) {
  Kernel out(lattice);
  out.tell(step);
  out.rebuilt_positions = positions_[current_].data();
  out.positions = out.rebuilt_positions;
  out.positions_before = positions_[1 - current_].data();
  return out;
}

template <class Kernel>
void CpuVerletPaper::advance(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions) {
  Kernel out = kernel<Kernel>(lattice, step);
  out.tool_motions = motions;
  runNodes(parallel_, lattice, out);
}

void CpuVerletPaper::persist(Archive& archive, CpuLattice& /*lattice*/) {
  for (const int i : {current_, 1 - current_}) archive.values(positions_[i]);
  archive.value(last_dt_s_);
}

void CpuVerletPaper::run(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions) {
  // x_prev is one substep before x: a substep of another length needs another x_prev.
  if (step.restarted || step.dt_s != last_dt_s_) runNodes(parallel_, lattice, kernel<glsl::Rebuild>(lattice, step));
  last_dt_s_ = step.dt_s;
  step.tools ? advance<glsl::AdvanceWithTools>(lattice, step, motions) : advance<glsl::Advance>(lattice, step, motions);
  current_ = 1 - current_;
}

}  // namespace viscera
