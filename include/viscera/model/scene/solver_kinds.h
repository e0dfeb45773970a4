// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "viscera/api.h"

namespace VISCERA_PUBLIC viscera {

// Values of the keys of the solver.

enum class Integrator { kLeapfrog, kVerletPaper, kPd };
/// Initial state of a simulation: everything at rest, or in equilibrium with gravity.
enum class SolverStart { kRest, kEquilibrium };
enum class Backend { kAuto, kGpu, kCpu };

}  // namespace viscera
