// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/vbd.h"

namespace viscera {

namespace glsl {

namespace {

#define VARIANT_NAME Descend
#define VARIANT_BASE ImplicitKernel
#define VARIANT_TEXT "shaders/solver/vbd.comp"
#define VARIANT_FEATURES WITH_DASHPOT
#include "solver/cpu/glsl_variant.inc"

#define VARIANT_NAME DescendVolumes
#define VARIANT_BASE ImplicitKernel
#define VARIANT_TEXT "shaders/solver/vbd.comp"
#define VARIANT_FEATURES WITH_DASHPOT | WITH_VOLUME
#include "solver/cpu/glsl_variant.inc"

#define VARIANT_NAME DescendContact
#define VARIANT_BASE ImplicitKernel
#define VARIANT_TEXT "shaders/solver/vbd.comp"
#define VARIANT_FEATURES WITH_DASHPOT | WITH_EVERY_CONTACT
#include "solver/cpu/glsl_variant.inc"

#define VARIANT_NAME DescendContactVolumes
#define VARIANT_BASE ImplicitKernel
#define VARIANT_TEXT "shaders/solver/vbd.comp"
#define VARIANT_FEATURES WITH_DASHPOT | WITH_EVERY_CONTACT | WITH_VOLUME
#include "solver/cpu/glsl_variant.inc"

}  // namespace

}  // namespace glsl

CpuVbd::CpuVbd(const CpuLattice& lattice, const Parallel& parallel, int iterations, CpuNodePairs* pairs)
    : implicit_(lattice, parallel, iterations, 1, pairs),
      parallel_(parallel),
      coloured_(byColour(lattice.store.active, !lattice.strengths.bulk.empty(), lattice.links.network)),
      iterations_(iterations) {}

template <class Kernel>
void CpuVbd::sweep(CpuLattice& lattice, const Substep& step) {
  auto kernel = implicit_.kernel<Kernel>(lattice, step);
  kernel.active_nodes = coloured_.slots.data();
  for (const Coloured::Colour& colour : coloured_.colours) {
    kernel.colour_first = colour.first;
    kernel.active_count = colour.count;
    runCount(parallel_, colour.count, kernel);
  }
}

void CpuVbd::sweepAll(CpuLattice& lattice, const Substep& step) {
  for (int iteration = 0; iteration < iterations_; ++iteration) {
    const bool volumes = !lattice.strengths.bulk.empty();
    if (implicit_.hasContacts(step)) {
      volumes ? sweep<glsl::DescendContactVolumes>(lattice, step) : sweep<glsl::DescendContact>(lattice, step);
    } else {
      volumes ? sweep<glsl::DescendVolumes>(lattice, step) : sweep<glsl::Descend>(lattice, step);
    }
    implicit_.movePairs(lattice, step, iteration);
  }
}

void CpuVbd::run(CpuLattice& lattice, const Substep& step, const layout::ToolMotion* motions) {
  begin(lattice, step, motions);
  sweepAll(lattice, step);
  end(lattice, step);
}

}  // namespace viscera
