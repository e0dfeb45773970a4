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
  kImplicitEuler  ///< solved to convergence: the reference for pd
};

/// Properties of an integrator, as seen by all code except its own steppers (physics.md 2).
struct IntegratorTraits {
  Integrator integrator;
  const char* name;   ///< name in scene files and tables
  const char* about;  ///< text for the key's description; null: only benchmarks of the papers can use it, scenes cannot
  ReferenceIntegrator truth;  ///< reference that it is compared with
  bool is_explicit;           ///< stable only below a substep, see stableFraction()
  bool dashpot_limits;        ///< the dashpot lowers that substep, as it acts on velocities of half a substep earlier
  bool staggered;             ///< velocities are half a substep earlier than displacements
  bool shortens;              ///< takes shorter substeps while the tissue is strained (dt_fraction_strained)
  bool own_positions;         ///< keeps positions in addition to the state, so that writing the state restarts it
  bool iterates;              ///< solver.iterations sets the number of passes over the nodes in a substep
  bool lets_bricks_sleep;     ///< steps only bricks that move
  bool compensates;           ///< can sum u and v with Kahan compensation
};

/// Indexed by the value of the enum.
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

/// Returns the largest substep over dt_safe at which an integrator is proven to be stable: f^2 + 2 xi f = 1 (physics.md
/// 2). Infinite for implicit ones. All code that plans, refuses or chooses a substep uses it.
/// @param stiffness_damping_ratio  xi, the largest of all bodies
double stableFraction(Integrator integrator, double stiffness_damping_ratio);

/// Returns the error to throw where steppers are made, for an integrator that is not implemented there.
/// @param by  the function
SceneError notStepped(Integrator integrator, const std::string& by);

}  // namespace viscera
