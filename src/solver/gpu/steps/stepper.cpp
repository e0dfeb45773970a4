// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/gpu/steps/stepper.h"

#include "model/scene/integrators.h"
#include "solver/device/pd.h"
#include "solver/gpu/steps/gpu_device.h"
#include "solver/gpu/steps/leapfrog_pass.h"
#include "solver/gpu/steps/verlet_paper_pass.h"

namespace viscera {

std::unique_ptr<Stepper> makeStepper(Integrator integrator, int iterations, const FeatureSet& features,
                                     const LatticeBuffers& buffers, const NodePairs* pairs, AwakeBricks* awake) {
  switch (integrator) {
    case Integrator::kVerletPaper:
      return std::make_unique<VerletPaperPass>(features, buffers);
    case Integrator::kPd:
      return std::make_unique<PdStepper<GpuDevice>>(GpuDevice(features, buffers, pairs), PdOptions{iterations});
    case Integrator::kLeapfrog:
      return std::make_unique<LeapfrogPass>(features, awake);
  }
  throw notStepped(integrator, "makeStepper()");
}

std::unique_ptr<Stepper> makeRecoveryStepper(int iterations, const FeatureSet& features,
                                             const LatticeBuffers& buffers) {
  PdOptions options;
  options.iterations = iterations;
  options.accelerated = false;
  return std::make_unique<PdStepper<GpuDevice>>(GpuDevice(features, buffers), options);
}

void setSubstep(const gpu::Program& program, const LatticeBuffers& buffers, const Substep& step) {
  program.set("active_count", static_cast<uint32_t>(buffers.store.active_count));
  program.set("dt_s", step.dt_s);
  program.set("kick_s", step.kick_s);
  program.set("gravity", {step.gravity.x(), step.gravity.y(), step.gravity.z()});
  program.set("sleep_distance_m", step.sleep_distance_m);
  if (!step.tools) return;
  program.set("slot_count", static_cast<uint32_t>(buffers.store.slot_count));
  program.set("push_speed", step.push_speed_m_per_s);
}

}  // namespace viscera
