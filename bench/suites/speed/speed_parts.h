// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "bench/harness/report.h"
#include "bench/harness/specimens/specimen.h"

namespace viscera::bench {

// The parts of the speed suite (docs/benchmarks.md, speed).

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
/// The scenes of `ticks` and `stages`: the one that is asked for, or a cube and a heart of each number of nodes.
std::vector<Scene> tickScenes(const Report& report);

/// Bytes read and written, and multiply-adds, that the machine does at most per second.
struct Limits {
  double copy, fma;  ///< bytes/s, flop/s
};
struct MachineLimits {
  Limits one, all;  ///< of the processor, with one thread and with all
};
/// Measures them, and the OpenGL renderer's where there is a context: table `machine`.
MachineLimits measureLimits(Report& report);
/// What the CPU's leapfrog does for a node of springs alone.
struct Work {
  double flop, bytes;
};
Work workOf(const Model& model, double dashpot);

/// Substeps per second and cost of a node by body and number of nodes, scalar loop, threads and GPU, beside VR05 Table
/// 1 and the machine's limits.
void measureSizes(Report& report);
/// Instruction sets of the CPU's kernels.
void measureSimd(Report& report);
/// VR05 Table 1's third column: the lattice with explicit connections, on both backends.
void measureExplicit(Report& report);
/// A heart of VR05's size in a scene as sessions have it: one probe pressed in, simulation only.
void measurePressedHeart(Report& report);
/// The same through Session, with skin and pictures: what of real time is left.
void measureHeartSessions(Report& report);
/// Features of the solver: switched on without effect against left out, results compared.
void measureFeatures(Report& report);
/// Bodies of the neo-Hookean law against bodies of springs of as many nodes.
void measureCells(Report& report);
/// Tissue at rest: asleep against awake, one corner awake, what sleeping changes.
void measureSleep(Report& report);
/// Skin and pictures that are not wanted, have not moved, or will not be seen.
void measureViews(Report& report);
/// Pictures with all of the skin in them and with nothing of it, with and without work for what is out.
void measureHidden(Report& report);
/// Time of a substep of a scene, or of a cube and a heart that hang, with state hashes.
void measureTicks(Report& report);
/// The same, stage by stage, by the GPU's own clock.
void measureTickStages(Report& report);

}  // namespace viscera::bench
