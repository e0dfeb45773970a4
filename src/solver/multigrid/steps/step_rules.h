// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

#include "solver/multigrid/steps/stage_solver.h"

namespace viscera::multigrid {

/// @throws SceneError  bodies with explicit connections, contacts between nodes: not stepped
void requireSteppable(const Model& model, bool node_contacts);
/// Of TR-BDF2: both of its stages have one matrix.
Stage trBdf2Stage(double dt_s);
/// Share of its velocities that a step of TR-BDF2 may keep, so that energy does not grow but by the work of who
/// touches; 0: none, it is done again by implicit Euler. @param given_j  that work, by their last forces
float keptSpeed(const Energy& before, const Energy& after, double given_j);
/// Newton's method needs no other step. @param step  that were made   @param changed  who is held
/// @param left_n, before_n  residual now and before the last one
bool isSolved(const Rule& rule, int step, bool changed, double left_n, double before_n, double noise_n);
/// Of one step of Newton's method in implicit Euler.
Rule eulerRule();

// Numbers of the steps (physics.md 2), the same on every backend.

const double kGamma = 2 - std::sqrt(2.0);              // with it both stages have one matrix
const double kSecond = (1 - kGamma) / (2 - kGamma);    // c / dt of BDF2
const double kOfMiddle = 1 / (kGamma * (2 - kGamma));  // A
const double kOfStart = kOfMiddle - 1;                 // B

constexpr int kMoreTouched = 2;           // Newton steps more while contacts come and go
constexpr double kTakes = 0.2;            // share of the kinetic energy that may be taken to keep energy from growing
constexpr double kGivenTimes = 2;         // the work of who touches, which is known by its last forces only
constexpr double kTrBdf2Rounding = 2e-6;  // of the energies that are summed: float32
constexpr double kFloatDisplacement = 6e-8;  // its rounding in float32, which springs turn into forces

// After cuts the levels are rebuilt.
constexpr int kStepsToBuild = 15;    // it takes no more than that on most machines; else the last one waits
constexpr int kStepsToRebuild = 20;  // after a cut: while a blade moves on, the old ones do

// Of implicit Euler
constexpr int kEulerNewton = 8;                                   // steps
constexpr double kEulerEnough = 0.1;                              // of the largest residual
constexpr int kEulerHalvings = 5;                                 // of one step
constexpr float kEulerKept[] = {1, 0.75f, 0.5f, 0.25f, 0.1f, 0};  // of the increments
constexpr double kEulerRounding = 1e-6;                           // of energies: float32

}  // namespace viscera::multigrid
