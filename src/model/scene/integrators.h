// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>

#include "viscera/math/error.h"
#include "viscera/model/scene/solver_kinds.h"

namespace viscera {

/// Time integration of the float64 reference (physics.md 2).
enum class ReferenceIntegrator {
  kLeapfrog,      ///< (u, v) half a substep apart, symmetric drag
  kVerletPaper,   ///< position Verlet with backward-difference drag, without dashpot (VR05, GW)
  kImplicitEuler  ///< solved to convergence: the truth for pd
};

/// What an integrator is: all that anybody but its own steppers may ask of it (physics.md 2).
struct IntegratorTraits {
  Integrator integrator;
  const char* name;   ///< in scene files and tables
  const char* about;  ///< in the key's sentence; null: scenes cannot ask for it, only benchmarks of the papers can
  ReferenceIntegrator truth;  ///< what it is held to
  bool is_explicit;           ///< stable below a substep only, see stableFraction()
  bool dashpot_limits;        ///< ... which the dashpot lowers: it acts on velocities of half a substep ago
  bool staggered;             ///< velocities belong to half a substep before the displacements
  bool shortens;              ///< has shorter substeps while the tissue is strained (dt_fraction_strained)
  bool own_positions;         ///< keeps positions beside the state: writing the state makes it start again
  bool iterates;              ///< solver.iterations says how often a substep goes over the nodes
  bool lets_bricks_sleep;     ///< steps only bricks that move
  bool compensates;           ///< can sum u and v with Kahan's compensation
};

/// By the value of the enum.
// clang-format off
constexpr std::array<IntegratorTraits, 3> kIntegrators = {{
    //   explicit dashpot stagger shorten own_pos iterate sleep  compens
    {Integrator::kLeapfrog, "leapfrog", "explicit, order 2", ReferenceIntegrator::kLeapfrog,
         true,    true,   true,   true,   false,  false,  true,  true},
    {Integrator::kVerletPaper, "verlet_paper", nullptr, ReferenceIntegrator::kVerletPaper,
         true,    false,  false,  false,  true,   false,  false, false},
    {Integrator::kPd, "pd", "implicit Euler", ReferenceIntegrator::kImplicitEuler,
         false,   false,  false,  false,  false,  true,   false, false},
}};
// clang-format on

constexpr const IntegratorTraits& traitsOf(Integrator integrator) {
  return kIntegrators[static_cast<size_t>(integrator)];
}

constexpr bool isInOrder() {
  for (size_t i = 0; i < kIntegrators.size(); ++i) {
    if (static_cast<size_t>(kIntegrators[i].integrator) != i) return false;
  }
  return true;
}
static_assert(isInOrder(), "kIntegrators is looked up by the value of the enum");

/// Largest substep over dt_safe with which an integrator is surely stable: f^2 + 2 xi f = 1 (physics.md 2); infinite
/// for implicit ones. The rule for all who plan, refuse or choose by it.
/// @param dashpot_ratio  xi, the largest of all bodies
double stableFraction(Integrator integrator, double dashpot_ratio);

/// What is thrown where steppers are made, of an integrator that is none of those made there.
/// @param by  the function
SceneError notStepped(Integrator integrator, const std::string& by);

}  // namespace viscera
