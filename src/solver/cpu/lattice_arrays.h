// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/cpu/cpu_lattice.h"
#include "solver/cpu/kernels.h"

namespace viscera {

/// A lattice as the SIMD kernels see it: from the current state into the other one, without compensation.
inline simd::Arrays arraysOf(CpuLattice& lattice) {
  simd::Arrays a{};
  a.bricks = lattice.bricks.data();
  a.bodies = lattice.bodies.data();
  a.displacement = lattice.displacement[lattice.current].data();
  a.velocity = lattice.velocity[lattice.current].data();
  a.next_displacement = lattice.displacement[1 - lattice.current].data();
  a.next_velocity = lattice.velocity[1 - lattice.current].data();
  a.spring_stiffness = lattice.both_ends.data();
  a.mobility = lattice.mobility.data();
  a.bulk_around = lattice.bulk_around.empty() ? nullptr : lattice.bulk_around.data();
  a.uniform = lattice.uniform.data();
  a.idle_rows = lattice.idle_rows.data();
  return a;
}

}  // namespace viscera
