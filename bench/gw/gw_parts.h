// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/gw/gw_network.h"
#include "bench/harness/report.h"

namespace viscera::bench {

// The measurements of the gw suite (docs/benchmarks.md, gw).

/// Measures GW Table 1: memory, fetches and operations, by GW's formulae and for the buffers and kernels used here.
void countCosts(Report& report);
/// Measures GW Table 2 (valence 6, up to 512 x 512 nodes) and the comparison at valences 3 to 12: time of every stage.
void measureStages(Report& report);
/// Measures the error of each method's forces against float64, which GW do not report.
void measureForceErrors(Report& report);
/// Measures the error of the motion against float64 over time, for a hanging cloth and a heart.
void measureMotionErrors(Report& report);
/// Measures the share of colliding pairs that the search finds, against brute force.
void collisionRecall(Report& report, bool brief);

}  // namespace viscera::bench
