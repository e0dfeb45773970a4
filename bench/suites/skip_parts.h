// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"
#include "viscera/gpu/context.h"

namespace viscera::bench {

// The measurements of the skip suite (docs/benchmarks.md).

/// Features of the solver: switched on without effect against left out, results compared.
void measureFeatures(Report& report);
/// Cells by moments against springs alone, on the same lattice.
void measureCells(Report& report);
/// Space without nodes: a hollow heart against a full cube, per active node.
void measureEmptySpace(Report& report);
/// Tissue at rest: asleep against awake, one corner awake, what sleeping changes.
void measureSleep(Report& report);
/// Skin and pictures that nobody wants, that have not moved, that nobody will see.
void measureViews(Report& report, gpu::Context& context);
/// Pictures of which some or all of the skin is out, with and without work for it. Needs a current context.
void measureHidden(Report& report);

}  // namespace viscera::bench
