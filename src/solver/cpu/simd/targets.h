// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

#include "solver/cpu/simd/kernels.h"

namespace viscera::simd {

/// Returns the place of an instruction set in the tables of HWY_EXPORT. The tables depend on what the including file is
/// compiled for, so files must not share this function.
static inline size_t positionOf(int64_t target) {
  hwy::ChosenTarget chosen;  // a local one, since the process-wide target says nothing about a single solver
  chosen.Update(target);
  return chosen.GetIndex();
}

/// Returns the entry of HWY_EXPORT(function) for one of the instruction sets of hwy::SupportedAndGeneratedTargets().
#if HWY_IDE || ((HWY_TARGETS & (HWY_TARGETS - 1)) == 0)  // the table has one entry then
#define VISCERA_KERNEL_FOR(function, target) (static_cast<void>(target), HWY_DISPATCH_TABLE(function)[0])
#else
#define VISCERA_KERNEL_FOR(function, target) HWY_DISPATCH_TABLE(function)[positionOf(target)]
#endif

// Returns the kernel of an instruction set, each from the file that compiles it.
// @param target  Highway's bit of the instruction set
BrickLeapfrog leapfrogFor(int64_t target);
BrickPredict predictFor(int64_t target);
BrickMeasure measureFor(int64_t target);
BrickCells cellsFor(int64_t target);
WallForces wallsFor(int64_t target);
WallForces measureWallsFor(int64_t target);
NetworkGroups spreadNetworkFor(int64_t target);
NetworkGroups leapfrogNetworkFor(int64_t target);
BrickSweep findPositionsFor(int64_t target);
BrickSides findSidesFor(int64_t target);

}  // namespace viscera::simd
