// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace viscera {

// What the keys of the solver choose among.

enum class Integrator { kLeapfrog, kVerletPaper, kPd };
/// What a simulation begins with: everything at rest, or hanging in its weight.
enum class SolverStart { kRest, kEquilibrium };
enum class Backend { kAuto, kGpu, kCpu };

}  // namespace viscera
