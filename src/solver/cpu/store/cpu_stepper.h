// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "solver/cpu/simd/kernels.h"
#include "solver/cpu/store/cpu_lattice.h"
#include "solver/cpu/store/parallel.h"
#include "solver/cpu/store/sleep.h"
#include "solver/tissue/substep.h"
#include "viscera/layout/tool_motion.h"
#include "viscera/model/scene/solver_kinds.h"
#include "viscera/solver/solver.h"

namespace viscera {

class Archive;

class CpuNetwork;
class CpuNodePairs;

/// An integrator on the CPU: one substep of every active node (physics.md 2).
class CpuStepper {
 public:
  virtual ~CpuStepper() = default;
  /// state -> other state; the caller swaps.
  /// @param motions  [kMaxStyluses] of this substep; looked at where step.tools
  virtual void run(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions) = 0;
  /// The state was written from outside: sums of rounding errors start at 0. (substep.h says of a new start in time.)
  virtual void restart() {}
  /// What substeps to come depend on beside the lattice (Solver::persist()).
  /// @param lattice  may be another one's afterwards, where it is read: the caller's goes next
  virtual void persist(Archive& /*archive*/, CpuLattice& /*lattice*/) {}
};

/// What integrators work with besides the lattice. All of it must outlive them.
struct CpuParts {
  const Parallel& parallel;
  Sleep& sleep;         ///< of the lattice: who can leave bricks out, does
  CpuNetwork* network;  ///< of the lattice; null where no body has explicit connections
  const FeatureSet& features;
  const simd::Kernels& kernels;
  CpuNodePairs* pairs = nullptr;  ///< contacts between nodes within an implicit substep; null: none
};

/// Leapfrog: SIMD kernels. pd and verlet_paper: the text of their shaders, compiled as C++.
/// @param iterations  of pd   @param lattice  that it will be run on
/// @throws SceneError  what the integrator cannot step
std::unique_ptr<CpuStepper> makeCpuStepper(Integrator integrator, int iterations, CpuLattice& lattice,
                                           const CpuParts& parts);

/// pd without acceleration, so that every sweep lowers the energy, for the governor's recoveries.
std::unique_ptr<CpuStepper> makeCpuRecoveryStepper(int iterations, CpuLattice& lattice, const Parallel& parallel);

}  // namespace viscera
