// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/gw/gw_network.h"
#include "bench/harness/report.h"

namespace viscera::bench {

// The measurements of the gw suite (docs/benchmarks.md, gw).

/// GW Table 1: memory, fetches and operations, by GW's formulae and of the buffers and kernels that are here.
void countCosts(Report& report);
/// GW Table 2 (valence 6, up to 512 x 512 nodes) and the comparison at valences 3 to 12: time of every stage.
void measureStages(Report& report);
/// What GW had no column for: error of the forces of every way against float64.
void measureForceErrors(Report& report);
/// Error of the motion against float64 over time, hanging cloth and heart.
void measureMotionErrors(Report& report);
/// Share of the colliding pairs that the search finds, against brute force.
void collisionRecall(Report& report, bool brief);

}  // namespace viscera::bench
