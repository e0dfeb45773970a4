// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

#include "solver/cpu/simd/kernels.h"

namespace viscera::simd {

/// Place of an instruction set in the tables that HWY_EXPORT makes. Those follow what the file was compiled for: not to
/// be shared between files.
static inline size_t placeOf(int64_t target) {
  hwy::ChosenTarget chosen;  // one of our own: the process's says nothing of a single solver
  chosen.Update(target);
  return chosen.GetIndex();
}

/// What HWY_EXPORT(function) has for one instruction set, of those that hwy::SupportedAndGeneratedTargets() names.
#if HWY_IDE || ((HWY_TARGETS & (HWY_TARGETS - 1)) == 0)  // the table has one entry then
#define VISCERA_KERNEL_FOR(function, target) (static_cast<void>(target), HWY_DISPATCH_TABLE(function)[0])
#else
#define VISCERA_KERNEL_FOR(function, target) HWY_DISPATCH_TABLE(function)[placeOf(target)]
#endif

// Each from the file that compiles it. @param target  Highway's bit of an instruction set
BrickLeapfrog leapfrogFor(int64_t target);
BrickPredict predictFor(int64_t target);
BrickMeasure measureFor(int64_t target);
BrickCells cellsFor(int64_t target);
WallForces wallsFor(int64_t target);
WallForces measureWallsFor(int64_t target);
NetworkGroups spreadNetworkFor(int64_t target);
NetworkGroups leapfrogNetworkFor(int64_t target);
BrickSweep findPlacesFor(int64_t target);
BrickSides findSidesFor(int64_t target);

}  // namespace viscera::simd
