// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "solver/cpu/simd/kernels.h"
#include "solver/cpu/state/cpu_lattice.h"
#include "solver/cpu/state/parallel.h"
#include "solver/cpu/state/sleep.h"
#include "solver/tissue/substep.h"
#include "viscera/layout/tool_motion.h"
#include "viscera/model/scene/solver_kinds.h"
#include "viscera/solver/solver.h"

namespace viscera {

class Archive;

class CpuNetwork;
class CpuNodePairs;

/// An integrator on the CPU. It makes one substep of every active node (physics.md 2).
class CpuStepper {
 public:
  virtual ~CpuStepper() = default;
  /// Steps from the current state to the other one; the caller swaps.
  /// @param motions  [kMaxStyluses] of this substep; read if step.tools
  virtual void run(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions) = 0;
  /// Clears sums of rounding errors after an external write to the state. (substep.h describes restarts in time.)
  virtual void restart() {}
  /// Saves or loads what later substeps depend on, apart from the lattice (Solver::persist()).
  /// @param lattice  may afterwards hold another lattice's values when loading: the caller loads its own next
  virtual void persist(Archive& /*archive*/, CpuLattice& /*lattice*/) {}
};

/// What integrators need besides the lattice. All of it must outlive them.
struct CpuParts {
  const Parallel& parallel;
  Sleep& sleep;         ///< of the lattice, for integrators that can skip sleeping bricks
  CpuNetwork* network;  ///< explicit connections; null where no body has any
  const FeatureSet& features;
  const simd::Kernels& kernels;
  CpuNodePairs* pairs = nullptr;  ///< contacts between nodes within an implicit substep; null: none
};

/// Creates an integrator. Leapfrog consists of SIMD kernels; pd and verlet_paper are the text of their shaders,
/// compiled as C++.
/// @param iterations  of pd
/// @param lattice  on which it will run
/// @throws SceneError  what the integrator cannot step
std::unique_ptr<CpuStepper> makeCpuStepper(Integrator integrator, int iterations, CpuLattice& lattice,
                                           const CpuParts& parts);

/// Creates pd without acceleration, so that every sweep lowers the energy, for recoveries of the stability monitor.
std::unique_ptr<CpuStepper> makeCpuRecoveryStepper(int iterations, CpuLattice& lattice, const Parallel& parallel);

}  // namespace viscera
