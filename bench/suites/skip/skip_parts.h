// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "bench/harness/report.h"
#include "bench/harness/specimens/specimen.h"
#include "viscera/gpu/context.h"

namespace viscera::bench {

// The measurements of the skip suite (docs/benchmarks.md).

/// A feature, switched on without effect, and the same scene without it.
struct Feature {
  std::string name;
  Specimen with, without;
  ToolMotions motions_with;  ///< those without it have none
  bool same_result = true;   ///< without it, the result is to be the same
};
/// All features that are measured, on cubes. @param edge  nodes per edge
std::vector<Feature> featuresOf(int edge);
/// A cube that is held at its top and, if it hangs, sags. It settles fast, so that it is soon asleep.
Specimen restingCube(int edge, bool sleeps, double gravity_m_per_s2);
/// Ticks of a solver until its body has come to rest. @param seconds  simulated
void settle(Solver& solver, const Scene& scene, const ToolMotions& motions, double seconds);

/// Features of the solver: switched on without effect against left out, results compared.
void measureFeatures(Report& report);
/// Cells by moments against springs alone, on the same lattice.
void measureCells(Report& report);
/// Space without nodes: a hollow heart against a full cube, per active node.
void measureEmptySpace(Report& report);
/// Tissue at rest: asleep against awake, one corner awake, what sleeping changes.
void measureSleep(Report& report);
/// Skin and pictures that are not wanted, have not moved, or will not be seen.
void measureViews(Report& report, gpu::Context& context);
/// Pictures with all of the skin in them and with nothing of it, with and without work for what is out. Needs a current
/// context.
void measureHidden(Report& report);

}  // namespace viscera::bench
