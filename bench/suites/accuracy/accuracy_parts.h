// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

// The measurements of the accuracy suite (docs/accuracy.md).

/// Error against dt -> 0 as the substep is halved, per integrator and kind of drag.
void measureOrder(Report& report);
/// Kernels against float64 with the same substep, near and far from the origin; positions against displacements.
void measureFloat32(Report& report);
/// |sum F| / sum |F| of a free block in a random state.
void measureMomentum(Report& report);
/// Energy of an undamped block over many substeps.
void measureEnergyDrift(Report& report);
/// Error against work, cantilever: integrator x substep x iterations.
void measureCantileverPrecision(Report& report);
/// Error of the heart under a probe by spacing, of springs and of the neo-Hookean law.
void measureSpacing(Report& report);
/// The same for the heart, pressed, grabbed, pulled and let go.
void measureHeartPrecision(Report& report);

}  // namespace viscera::bench
