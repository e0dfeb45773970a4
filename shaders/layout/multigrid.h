// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// Arrays of integrator multigrid on the GPU (solver/gpu/steps/multigrid_pass.h). Vectors of the finest level are vec4[slots], one after the
// other: number n begins at n * slots.
#ifndef VISCERA_LAYOUT_MULTIGRID_H
#define VISCERA_LAYOUT_MULTIGRID_H
#include "viscera/layout/types.h"

#ifdef __cplusplus
namespace viscera::layout {
#endif

// Of a step
const uint kStepVelocity = 0u;   // at its start [m/s]
const uint kStepLeft = 1u;       // at the end of the last one [m/s]
const uint kStepEnded = 2u;      // displacement there [m]
const uint kStepLoad = 3u;       // beside gravity [N]
const uint kStepWanted = 4u;     // dy [m]
const uint kStepOffset = 5u;     // dw [m]
const uint kStepIncrement = 6u;  // du [m]
const uint kStepTrial = 7u;      // another one, to go back to [m]
const uint kStepPlace = 8u;      // u + du, where all is linear [m]
const uint kStepSpeed = 9u;      // rate (du - dw) there [m/s]
const uint kStepForce = 10u;     // of springs, dashpots and cells there [N]
const uint kStepVectors = 11u;

// Of a system
const uint kSystemResidual = 0u;
const uint kSystemSolution = 1u;
const uint kSystemDirection = 2u;
const uint kSystemProduct = 3u;
const uint kSystemCorrection = 4u;  // of a V-cycle
const uint kSystemChange = 5u;      // the last one of a smoother
const uint kSystemWork = 6u;        // a residual that a V-cycle overwrites
const uint kSystemInverse = 7u;     // [m/N] of the block diagonal: xx, xy, xz, yy
const uint kSystemInverse2 = 8u;    // yz, zz; z inertia and drag [N/m]; w 1 of nodes that may move, else 0
const uint kSystemVectors = 9u;

// Of what touches
const uint kTouchedNormal = 0u;   // xyz of a plane that the node keeps to, or 0; w 1: it is held
const uint kTouchedNormal2 = 1u;  // of another one, at right angles
const uint kTouchedWay = 2u;      // xyz, of held nodes: in the whole step [m]; w bits: kTouches...
const uint kTouchedLacks = 3u;    // what its balance lacks [N]
const uint kTouchedVectors = 4u;

const uint kTouchesHeld = 1u;     // by a hand
const uint kTouchesPresses = 2u;  // prescribed or kept to a plane
const uint kTouchesSticks = 4u;   // to the surface that it touches
const uint kTouchesEvenly = 8u;   // goes on evenly in the rest of the step
const uint kTouchesBefore = 16u;  // was pressed or held at the end of the last step
const uint kTouchesMaskShift = 8u;  // from there on: contacts that press

// Rows of sums, four each
const uint kSumsBalance = 0u;    // residual squared, place squared, kinetic energy, work of gravity and load
const uint kSumsTouch = 1u;      // what implicit Euler adds to the potential, work of who touches
const uint kSumsSprings = 2u;    // energy
const uint kSumsCells = 3u;      // energy
const uint kSumsRz = 4u;         // residual times correction
const uint kSumsCurvature = 5u;  // direction times product
const uint kSumsLeft = 6u;       // residual squared
const uint kSumsRows = 7u;

/// What the host reads, and what kernels of an iteration take from earlier ones.
struct MultigridScalars {
  float alpha, beta;
  uint changed;  // 1: others are held or pressed than before
  uint pad;
  uvec4 more;  // sums begin at 32 bytes
};

// What starts a stage
const uint kStageTrapezoidal = 0u;
const uint kStageBdf2 = 1u;
const uint kStageEuler = 2u;

// What becomes of increments
const uint kIncrementSolve = 0u;  // the solution is added
const uint kIncrementTamed = 5u;  // what multigrid_tame.comp made of it
const uint kIncrementSlow = 6u;   // speed = share speed
const uint kIncrementKeep = 1u;   // trial = increment
const uint kIncrementBack = 2u;   // increment = trial + share (increment - trial)
const uint kIncrementGuess = 3u;  // increment = share dy
const uint kIncrementShare = 4u;  // increment = share trial

#ifdef __cplusplus
}  // namespace viscera::layout
#endif
#endif
