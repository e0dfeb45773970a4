// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

/// Does the tissue stay finite and bounded whatever is done to it (docs/stability.md)?
void stabilitySuite(Report& report);

// Its parts, in the order of the report.
void startsOfStability(Report& report);     ///< extreme starts x integrators x substeps
void fractionsOfStability(Report& report);  ///< how far the substep may go towards its limit
void measuredOfStability(Report& report);   ///< substeps as the fastest mode allows, from extreme starts
void strainOfStability(Report& report);     ///< how much faster the fastest mode of strained tissue is
void toolsOfStability(Report& report);      ///< fast and jumping tools, a grab pulled to 10x, random cuts
void woundsOfStability(Report& report);     ///< ten thousand cuts with their wounds: the last against the first
void placesOfStability(Report& report);     ///< far from the origin, with tools and skin; in other sizes
void extremesOfStability(Report& report);   ///< stiffness and mass ratios, a long rest, units, equal hashes

}  // namespace viscera::bench
