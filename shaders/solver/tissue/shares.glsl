// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Shares of the increments from which the best is chosen, at the start and at the end of a substep of implicit Euler
// (implicit_guess.comp, implicit_fold.comp).
const vec4 kShares = vec4(0.0f, 0.5f, 0.75f, 1.0f);
const float kRounding = 1e-6f;  // of sums of energies: smaller differences are rounding

/// Two vectors per node: P per share [J]; energy before the substep, then after it with shares 1, 2, 3 [J].
#define ENERGIES_PER_NODE 2u
