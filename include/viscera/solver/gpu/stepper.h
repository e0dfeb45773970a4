// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "viscera/gpu/program.h"
#include "viscera/solver/gpu/features.h"
#include "viscera/solver/gpu/lattice_buffers.h"

namespace viscera {

/// One substep, as every integrator is told of it.
struct Substep {
  float dt_s = 0;
  float kick_s = 0;  ///< leapfrog: half the substep before and half this one; half of dt_s in the very first
  Vector3f gravity = Vector3f::Zero();  ///< [m/s2]
  float sleep_distance_m = 1;
  float push_speed_m_per_s = 0;  ///< largest speed at which a probe pushes nodes out
  bool tools = false;            ///< probe or held nodes are about: the kernel that knows them is used
  bool restarted = false;        ///< the state was written from outside since the last substep
};

/// An integrator: one substep of every active node (physics.md 2).
class Stepper {
 public:
  virtual ~Stepper() = default;
  /// state -> other state; the caller swaps. buffers must be bound.
  virtual void run(LatticeBuffers& buffers, const Substep& step) = 0;
};

/// The integrator's kernels, compiled. @param iterations  of vbd and pd
/// @throws GpuError with file, line and the driver's log
std::unique_ptr<Stepper> makeStepper(Integrator integrator, int iterations, const FeatureSet& features,
                                     const LatticeBuffers& buffers);

/// pd without acceleration, so that every sweep lowers the energy, for the governor's recoveries.
std::unique_ptr<Stepper> makeRecoveryStepper(int iterations, const FeatureSet& features, const LatticeBuffers& buffers);

/// Sets the uniforms of shaders/step.glsl for the program in use.
void setSubstep(const LatticeBuffers& buffers, const Substep& step);

}  // namespace viscera
