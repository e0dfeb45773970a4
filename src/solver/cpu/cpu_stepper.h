// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "solver/cpu/cpu_lattice.h"
#include "solver/cpu/parallel.h"
#include "solver/substep.h"

namespace viscera {

/// An integrator on the CPU: one substep of every active node (physics.md 2).
class CpuStepper {
 public:
  virtual ~CpuStepper() = default;
  /// state -> other state; the caller swaps.
  /// @param motions  [kMaxStyluses] of this substep; looked at where step.tools
  virtual void run(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions) = 0;
};

/// vbd, pd and verlet_paper: the text of their shaders, compiled as C++. (Leapfrog is another's affair.)
/// @param iterations  of vbd and pd   @param lattice  that it will be run on   @param parallel  must outlive the
/// stepper
std::unique_ptr<CpuStepper> makeCpuStepper(Integrator integrator, int iterations, CpuLattice& lattice,
                                           const Parallel& parallel);

/// pd without acceleration, so that every sweep lowers the energy, for the governor's recoveries.
std::unique_ptr<CpuStepper> makeCpuRecoveryStepper(int iterations, CpuLattice& lattice, const Parallel& parallel);

}  // namespace viscera
