// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

/// Measures whether the tissue stays finite and bounded under any treatment (docs/verification.md).
void stabilitySuite(Report& report);

// Its parts, in the order of the report.
void startsOfStability(Report& report);     ///< extreme starts x integrators x substeps
void fractionsOfStability(Report& report);  ///< substep length relative to its limit
void measuredOfStability(Report& report);   ///< substeps from the measured fastest mode, from extreme starts
void strainOfStability(Report& report);     ///< ratio of the fastest mode of strained tissue to that at rest
void toolsOfStability(Report& report);      ///< fast and jumping tools, a grab pulled to 10x, random cuts
void woundsOfStability(Report& report);     ///< ten thousand cuts: cost of the last against the first
void positionsOfStability(Report& report);  ///< far from the origin, with tools and surface mesh; in other sizes
void extremesOfStability(Report& report);   ///< stiffness and mass ratios, a long rest, units, equal hashes

}  // namespace viscera::bench
