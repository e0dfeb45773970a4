// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

// The measurements of the accuracy suite (docs/verification.md).

/// Measures the error against dt -> 0 as the substep is halved, per integrator and kind of drag.
void measureOrder(Report& report);
/// Compares kernels with float64 at the same substep, near and far from the origin; and positions with displacements.
void measureFloat32(Report& report);
/// Measures |sum F| / sum |F| of a free block in a random state.
void measureMomentum(Report& report);
/// Measures the energy of an undamped block over many substeps.
void measureEnergyDrift(Report& report);
/// Measures error against work for a cantilever: integrator x substep x iterations.
void measureCantileverPrecision(Report& report);
/// Measures the error of the heart under a probe by spacing, for springs and the neo-Hookean law.
void measureSpacing(Report& report);
/// Measures error against work for the heart: pressed, grabbed, pulled and released.
void measureHeartPrecision(Report& report);

}  // namespace viscera::bench
