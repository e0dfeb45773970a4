// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/ticks/solver_backend.h"
#include "viscera/model/model.h"
#include "viscera/model/scene/solver_config.h"

namespace viscera {

/// Does a scene take substeps as long as measured ones may be (solver.measured_limit)? Leapfrog under a governor, with
/// substeps of its own choice, where all bodies are lattices.
bool measuresLimit(const Model& model, const SolverConfig& config);

/// Longest substep with which leapfrog is stable in tissue at rest [s]: 2 / omega_max, omega_max by Lanczos' method
/// with the backend's own forces, and what that may still lack of it on top (Zhou and Li, Bounding the spectrum of
/// large Hermitian matrices, 2011). The state is that of rest afterwards. Infinite where nothing can swing.
double measureLimit_s(SolverBackend& backend, const Model& model);

/// How much faster the fastest mode of strained tissue may be than at rest, at most (docs/physics.md 2).
/// @param stretch  largest |L - l0| / l0, >= 0
double strainFactor(double stretch);

/// How much shorter substeps must be than at rest for cells of a hyperelastic law.
/// @param stiffening  q, of the fastest wave squared over that at rest, >= 1 (lawStiffening() of law.glsl)
double lawFactor(double stiffening);

/// Returns how much stiffer (lawFactor()) cells with a prestress are at most when a cut lets them go: at twice the
/// strain that they would have then, as they overshoot. The state is that of rest afterwards. 0 without a prestress.
double releasedStiffening(SolverBackend& backend, const Model& model);

/// Substep that follows from a measured limit [s]: in proportion to dt_fraction, and never shorter than by dt_fraction;
/// of tissue stretched by more than kStrainedStretch, by dt_fraction_strained.
/// @param dashpot_ratio  xi, the largest of all bodies   @param stretch  as of strainFactor()
double measuredSubstep_s(const SolverConfig& config, double dashpot_ratio, double dt_safe_s, double dt_limit_s,
                         double stretch);

}  // namespace viscera
