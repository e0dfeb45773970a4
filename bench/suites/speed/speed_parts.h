// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "bench/harness/report.h"
#include "bench/harness/specimens/specimen.h"

namespace viscera::bench {

// The parts of the speed suite (docs/benchmarks.md, speed).

/// A feature that is enabled without effect, and the same scene without it.
struct Feature {
  std::string name;
  Specimen with, without;
  ToolMotions motions_with;  ///< motions with the feature; without it there are none
  bool same_result = true;   ///< whether the result must be the same without it
};
/// Returns all features that are measured, on cubes. @param edge  nodes per edge
std::vector<Feature> featuresOf(int edge);
/// Creates a cube that is fixed at its top and sags under gravity. It settles fast, so that it soon sleeps.
Specimen restingCube(int edge, bool sleeps, double gravity_m_per_s2);
/// Steps a solver until its body has come to rest. @param seconds  simulated time
void settle(Solver& solver, const Scene& scene, const ToolMotions& motions, double seconds);
/// Returns the scenes of `ticks` and `stages`: the requested one, or a cube and a heart of each number of nodes.
std::vector<Scene> tickScenes(const Report& report);

/// The limits of the machine per second: bytes read and written, and multiply-adds.
struct Limits {
  double copy, fma;  ///< [bytes/s], [flop/s]
};
struct MachineLimits {
  Limits one, all;  ///< of the CPU, with one thread and with all
};
/// Measures the limits, and those of the OpenGL renderer if there is a context: table `machine`.
MachineLimits measureLimits(Report& report);
/// Work of the CPU's leapfrog per node of springs.
struct Work {
  double flop, bytes;
};
Work workOf(const Model& model, double dashpot);

/// Measures substeps per second and cost of a node by body and number of nodes, for scalar loop, threads and GPU, next
/// to VR05 Table 1 and the machine's limits.
void measureSizes(Report& report);
/// Measures the instruction sets of the CPU's kernels.
void measureSimd(Report& report);
/// Measures VR05 Table 1's third column: the lattice with explicit connections, on both backends.
void measureExplicit(Report& report);
/// Measures a heart of VR05's size in a scene as in sessions: one probe pressed in, simulation only.
void measurePressedHeart(Report& report);
/// Measures the same heart in a Session, with surface mesh and images: the remaining share of real time.
void measureHeartSessions(Report& report);
/// Measures features of the solver: enabled without effect against left out, with comparison of results.
void measureFeatures(Report& report);
/// Compares bodies of the neo-Hookean law with bodies of springs with the same number of nodes.
void measureCells(Report& report);
/// Measures tissue at rest: asleep against awake, one corner awake, and the effect of sleeping on results.
void measureSleep(Report& report);
/// Measures surface meshes and images that are not requested, have not moved, or will not be seen.
void measureViews(Report& report);
/// Measures images with all of the surface in view and with none, with and without culling.
void measureHidden(Report& report);
/// Measures the time of a substep of a scene, or of a hanging cube and heart, with state hashes.
void measureTicks(Report& report);
/// Measures the same by stage, by the GPU's own clock.
void measureTickStages(Report& report);

}  // namespace viscera::bench
