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

/// An integrator: one substep of every active node (physics.md 2).
class Stepper {
 public:
  virtual ~Stepper() = default;
  /// state -> other state; the caller swaps. buffers must be bound.
  virtual void run(LatticeBuffers& buffers, const Substep& step) = 0;
  /// The state was written from outside.
  virtual void restart() {}
  /// What substeps to come depend on beside the lattice's buffers (Solver::persist()).
  virtual void persist(Archive& /*archive*/) {}
};

/// The kernels of an integrator, compiled. @param iterations  of pd
/// @param pairs  contacts between nodes within an implicit substep; null: none
/// @param awake  of leapfrog: steps only these, and says when they were; null: steps all. Must outlive the stepper
/// @throws GpuError with file, line and the driver's log
std::unique_ptr<Stepper> makeStepper(Integrator integrator, int iterations, const FeatureSet& features,
                                     const LatticeBuffers& buffers, const NodePairs* pairs = nullptr,
                                     AwakeBricks* awake = nullptr);

/// pd without acceleration, so that every sweep lowers the energy, for the governor's recoveries.
std::unique_ptr<Stepper> makeRecoveryStepper(int iterations, const FeatureSet& features, const LatticeBuffers& buffers);

/// Sets the uniforms of shaders/solver/tissue/step.glsl.
void setSubstep(const gpu::Program& program, const LatticeBuffers& buffers, const Substep& step);

}  // namespace viscera
