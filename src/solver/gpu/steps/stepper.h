// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "gpu/program.h"
#include "solver/gpu/buffers/lattice_buffers.h"
#include "solver/tissue/features.h"
#include "solver/tissue/substep.h"
#include "viscera/model/scene/solver_kinds.h"
#include "viscera/solver/solver.h"

namespace viscera {

class Archive;

class AwakeBricks;
class NodePairs;

/// An integrator on the GPU. It makes one substep of every active node (physics.md 2).
class Stepper {
 public:
  virtual ~Stepper() = default;
  /// Steps from the current state to the other one; the caller swaps. The buffers must be bound.
  virtual void run(LatticeBuffers& buffers, const Substep& step) = 0;
  /// Restarts after an external write to the state.
  virtual void restart() {}
  /// Saves or loads what later substeps depend on, apart from the lattice's buffers (Solver::persist()).
  virtual void persist(Archive& /*archive*/) {}
};

/// Compiles the kernels of an integrator.
/// @param iterations  of pd
/// @param pairs  contacts between nodes within an implicit substep; null: none
/// @param awake  leapfrog steps and reports only these bricks; null: steps all. Must outlive the stepper
/// @throws GpuError with file, line and the driver's log
std::unique_ptr<Stepper> makeStepper(Integrator integrator, int iterations, const FeatureSet& features,
                                     const LatticeBuffers& buffers, const NodePairs* pairs = nullptr,
                                     AwakeBricks* awake = nullptr);

/// Creates pd without acceleration, so that every sweep lowers the energy, for recoveries of the stability monitor.
std::unique_ptr<Stepper> makeRecoveryStepper(int iterations, const FeatureSet& features, const LatticeBuffers& buffers);

/// Sets the uniforms of shaders/solver/tissue/step.glsl.
void setSubstep(const gpu::Program& program, const LatticeBuffers& buffers, const Substep& step);

}  // namespace viscera
