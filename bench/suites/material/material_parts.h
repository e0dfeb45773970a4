// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

// The measurements of the material suite, one file each (docs/material.md).

/// E and nu of bars 1 to 8 cells thick, from virtual tension tests; cell and paper weights.
void measureTension(Report& report);
/// Lateral stretch and nominal stress under large uniaxial stretch (physics.md 6, oracle 5).
void measureFiniteStretch(Report& report);
/// Frequencies of chains of masses (physics.md 6, oracle 2).
void measureChains(Report& report);
/// Frequencies of plane waves along an axis of the lattice (physics.md 6, oracle 6).
void measurePlaneWaves(Report& report);
/// Tip deflection of cantilevers against Timoshenko's beam (physics.md 6, oracle 7).
void measureCantilever(Report& report);
/// Force on a sphere pressed into the tissue, against Hertz.
void measureIndentation(Report& report);
/// Compliance of beams, rings, rods, plates, tubes and shells of few cells, of the default material.
void measureWalls(Report& report);
/// A beam bent into a circle: moment over E I kappa.
void measureCircle(Report& report);
/// A block on slopes and sliding, against Coulomb's law; a stack of boxes.
void measureContact(Report& report);
/// The neo-Hookean law beside CalculiX: a clamped block pulled, squeezed and sheared, a sphere pressed into a block.
void measureLaw(Report& report);

}  // namespace viscera::bench
