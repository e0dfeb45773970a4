// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/ticks/solver_backend.h"
#include "viscera/model/model.h"
#include "viscera/model/scene/solver_config.h"

namespace viscera {

/// Returns whether a scene takes substeps up to the measured limit (solver.measured_limit): leapfrog with a stability
/// monitor and a substep of its own choice, where all bodies are lattices.
bool measuresLimit(const Model& model, const SolverConfig& config);

/// Returns the longest substep with which leapfrog is stable in tissue at rest [s]: 2 / omega_max. Lanczos' method with
/// the backend's own forces gives omega_max, plus a bound on its error (Zhou and Li, Bounding the spectrum of large
/// Hermitian matrices, 2011). Afterwards the state is that of rest. Infinite if nothing can oscillate.
double measureLimit_s(SolverBackend& backend, const Model& model);

/// Returns the longest stable substep [s] of tissue with springs that are not part of it, as of attachments.
/// @param dt_s  that of the tissue   @param rate_per_s2  bound of the squared frequency that they add
double stepWith(double dt_s, double rate_per_s2);

/// Returns the upper bound of the ratio of the fastest mode of strained tissue to that at rest (docs/physics.md 2).
/// @param stretch  largest |L - l0| / l0, >= 0
double strainFactor(double stretch);

/// Returns the factor by which substeps must be shorter than at rest for cells of a hyperelastic law.
/// @param stiffening  q, square of the fastest wave over that at rest, >= 1 (lawStiffening() of law.glsl)
double lawFactor(double stiffening);

/// Returns the upper bound of the stiffening (lawFactor()) of cells with a prestress when a cut frees them. It is taken
/// at three times the strain that they would have then, as they overshoot, and at a strain of at most 0.6. Afterwards
/// the state is that of rest. 0 without a prestress.
double releasedStiffening(SolverBackend& backend, const Model& model);

/// Returns the substep that follows from a measured limit [s]. It is proportional to dt_fraction, and never shorter
/// than the substep by dt_fraction; in tissue stretched by more than kStrainedStretch, than that by
/// dt_fraction_strained.
/// @param stiffness_damping_ratio  xi, the largest of all bodies   @param stretch  as of strainFactor()
double measuredSubstep_s(const SolverConfig& config, double stiffness_damping_ratio, double dt_safe_s,
                         double dt_limit_s, double stretch);

}  // namespace viscera
