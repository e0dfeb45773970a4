// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/state/cpu_stepper.h"

#include "model/scene/integrators.h"
#include "solver/cpu/steps/cpu_device.h"
#include "solver/cpu/steps/leapfrog.h"
#include "solver/cpu/steps/verlet_paper.h"
#include "solver/device/pd.h"

namespace viscera {

std::unique_ptr<CpuStepper> makeCpuStepper(Integrator integrator, int iterations, CpuLattice& lattice,
                                           const CpuParts& parts) {
  switch (integrator) {
    case Integrator::kVerletPaper:
      return std::make_unique<CpuVerletPaper>(lattice, parts.parallel);
    case Integrator::kPd:
      return std::make_unique<PdStepper<CpuDevice>>(CpuDevice(lattice, parts.parallel, parts.pairs),
                                                    PdOptions{iterations});
    case Integrator::kLeapfrog:
      return std::make_unique<CpuLeapfrog>(lattice, parts);
  }
  throw notStepped(integrator, "makeCpuStepper()");
}

std::unique_ptr<CpuStepper> makeCpuRecoveryStepper(int iterations, CpuLattice& lattice, const Parallel& parallel) {
  PdOptions options;
  options.iterations = iterations;
  options.accelerated = false;
  return std::make_unique<PdStepper<CpuDevice>>(CpuDevice(lattice, parallel), options);
}

}  // namespace viscera
