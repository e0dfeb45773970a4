// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/cpu_stepper.h"

#include <cassert>

#include "solver/cpu/pd.h"
#include "solver/cpu/vbd.h"
#include "solver/cpu/verlet_paper.h"

namespace viscera {

std::unique_ptr<CpuStepper> makeCpuStepper(Integrator integrator, int iterations, CpuLattice& lattice,
                                           const Parallel& parallel) {
  assert(integrator != Integrator::kLeapfrog);
  if (integrator == Integrator::kVerletPaper) return std::make_unique<CpuVerletPaper>(lattice, parallel);
  if (integrator == Integrator::kVbd) return std::make_unique<CpuVbd>(lattice, parallel, iterations);
  return std::make_unique<CpuPd>(lattice, parallel, PdOptions{iterations});
}

std::unique_ptr<CpuStepper> makeCpuRecoveryStepper(int iterations, CpuLattice& lattice, const Parallel& parallel) {
  PdOptions options;
  options.iterations = iterations;
  options.accelerated = false;
  return std::make_unique<CpuPd>(lattice, parallel, options);
}

}  // namespace viscera
