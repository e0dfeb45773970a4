// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/cpu/simd/kernels.h"
#include "solver/cpu/state/cpu_lattice.h"

namespace viscera {

/// Returns the arrays of a lattice for the SIMD kernels: from the current state to the other one, without compensation.
inline simd::Arrays arraysOf(CpuLattice& lattice) {
  simd::Arrays a{};
  a.bricks = lattice.store.bricks.data();
  a.bodies = lattice.store.bodies.data();
  a.displacement = lattice.state.displacement[lattice.state.current].data();
  a.velocity = lattice.state.velocity[lattice.state.current].data();
  a.next_displacement = lattice.state.displacement[1 - lattice.state.current].data();
  a.next_velocity = lattice.state.velocity[1 - lattice.state.current].data();
  a.spring_stiffness = lattice.strengths.both_ends.data();
  a.mobility = lattice.strengths.mobility.data();
  a.nodes = lattice.store.nodes.data();
  a.uniform = lattice.strengths.uniform.data();
  a.idle_rows = lattice.strengths.idle_rows.data();
  return a;
}

/// Returns its cells; without rigidity if none has a law. The caller sets the sums.
inline simd::CellJob cellsOf(CpuLattice& lattice) {
  simd::CellJob job{};
  if (lattice.strengths.rigidity.empty()) return job;
  job.arrays = arraysOf(lattice);
  job.idle_rows = lattice.strengths.idle_cells.data();
  job.bulk = lattice.strengths.bulk.data();
  job.rigidity = lattice.strengths.rigidity.data();
  job.moments = lattice.strengths.brick_moments.data();
  job.partial_rows = lattice.strengths.partial_rows.data();
  job.tension = lattice.strengths.brick_tensions.data();
  job.laminates = lattice.strengths.brick_laminates.data();
  job.broken = lattice.strengths.broken.data();
  job.parts = lattice.strengths.has_parts;
  return job;
}

}  // namespace viscera
