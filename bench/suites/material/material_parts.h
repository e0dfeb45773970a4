// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "bench/harness/report.h"

namespace viscera::bench {

// The measurements of the material suite, one file each (docs/verification.md).

/// Measures E and nu of bars 1 to 8 cells thick, from virtual tension tests; cell and paper weights.
void measureTension(Report& report);
/// Measures lateral stretch and nominal stress under large uniaxial stretch (physics.md 6, oracle 5).
void measureFiniteStretch(Report& report);
/// Measures frequencies of chains of masses (physics.md 6, oracle 2).
void measureChains(Report& report);
/// Measures frequencies of plane waves along an axis of the lattice (physics.md 6, oracle 6).
void measurePlaneWaves(Report& report);
/// Compares the tip deflection of cantilevers with Timoshenko's beam (physics.md 6, oracle 7).
void measureCantilever(Report& report);
/// Compares the force on a sphere pressed into the tissue with Hertz's law.
void measureIndentation(Report& report);
/// Measures the compliance of beams, rings, rods, plates, tubes and shells of few cells, of the default material.
void measureWalls(Report& report);
/// Curvatures a beam into a circle: moment over E I kappa.
void measureCircle(Report& report);
/// Compares a block on slopes and sliding with Coulomb's law; also a stack of boxes.
void measureContact(Report& report);
/// Compares the neo-Hookean law with CalculiX: a clamped block in tension, compression and shear, and a sphere pressed
/// into a block.
void measureLaw(Report& report);

}  // namespace viscera::bench
