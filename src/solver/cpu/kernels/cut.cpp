// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "layout/blade.h"
#include "solver/cpu/kernels/glsl_kernel.h"
#include "solver/cpu/kernels/tool_passes.h"

namespace viscera {

namespace glsl {

namespace {

struct CutStats {
  uint springs_cut = 0;
};

struct CutKernel : Kernel {
  explicit CutKernel(CpuLattice& lattice)
      : Kernel(lattice), axial_cut(lattice.axial_cut.data()), cut_sides(lattice.cut_sides) {}
  float* axial_cut;
  Vectors cut_sides;
  uint stylus = 0;
  CutStats stats;
  const NearBlade* near = nullptr;
  bool mayCross(uint slot, uint other) const { return near->mayCross(slot, other); }
};

/// Returns 1 if a node loses a spring. It is evaluated for all nodes before any loses one, so that the result does not
/// depend on their order, as in cut.comp.
#define SEVERED(spring, offset)                                                  \
  if (springCount(bits, spring) != 0u) {                                         \
    const uint n = neighborSlot(slot, offset);                                   \
    if (mayCross(slot, n) && severingPart(slot, own, n, m, sphere, h)) return 1; \
  }
#define LOSES_SPRINGS                                          \
  uint64_t loses(uint slot) {                                  \
    const NodeBits bits = nodes[slot];                         \
    const ToolMotion& m = tool_motions[stylus];                \
    const float h = bodies[bodyOf(bits)].origin_spacing.w;     \
    const vec3 x = seenFromBlade(slot, m, h);                  \
    const vec4 sphere = bladeSphere(m, h);                     \
    if (isIsolated(bits) || farFromBlade(x, sphere)) return 0; \
    const vec3 own = onItsSide(slot, x, m, h);                 \
    FOR_EACH_SPRING(SEVERED)                                   \
    return 0;                                                  \
  }

#define VARIANT_NAME CutSprings
#define VARIANT_BASE CutKernel
#define VARIANT_TEXT "shaders/solver/tools/cut.comp"
#define VARIANT_FEATURES WITH_RECORD
#define VARIANT_MEMBERS LOSES_SPRINGS
#include "solver/cpu/kernels/glsl_variant.inc"

#define VARIANT_NAME CutSpringsForgetting
#define VARIANT_BASE CutKernel
#define VARIANT_TEXT "shaders/solver/tools/cut.comp"
#define VARIANT_MEMBERS LOSES_SPRINGS
#include "solver/cpu/kernels/glsl_variant.inc"

#define VARIANT_NAME CutParticlesForgetting
#define VARIANT_BASE CutKernel
#define VARIANT_TEXT "shaders/solver/tools/cut.comp"
#define VARIANT_FEATURES WITH_PARTICLES
#define VARIANT_MEMBERS LOSES_SPRINGS
#include "solver/cpu/kernels/glsl_variant.inc"

#define VARIANT_NAME CutParticles
#define VARIANT_BASE CutKernel
#define VARIANT_TEXT "shaders/solver/tools/cut.comp"
#define VARIANT_FEATURES WITH_PARTICLES | WITH_RECORD
#define VARIANT_MEMBERS LOSES_SPRINGS
#include "solver/cpu/kernels/glsl_variant.inc"
#undef LOSES_SPRINGS
#undef SEVERED

struct CellKernel : Kernel {
  using Kernel::Kernel;
  uint cell_count = 0;
};

#define VARIANT_NAME TearCell
#define VARIANT_BASE CellKernel
#define VARIANT_TEXT "shaders/solver/tissue/cell_forces.comp"
#define VARIANT_FEATURES WITH_CUT
#include "solver/cpu/kernels/glsl_variant.inc"

}  // namespace

}  // namespace glsl

namespace {

/// Returns for each slot the largest distance of its tissue from the node [m], for any deformation: the offset at rest,
/// plus as much along every axis where the edge is stretched or turned (shaders/solver/tissue/surface_offset.glsl).
std::vector<float> tissueReaches(CpuLattice& lattice) {
  std::vector<float> out(lattice.slotCount());
  glsl::CutSprings kernel(lattice);
  for (const uint32_t slot : lattice.store.active) {
    const uint32_t offset = kernel.surfaceOffset(slot);
    if (offset == 0) continue;
    const glsl::vec3 cells = kernel.offsetInCells(offset);
    const float along_axes = std::abs(cells.x) + std::abs(cells.y) + std::abs(cells.z);
    out[slot] = lattice.store.bodyOf(slot).origin_spacing.w * (glsl::length(cells) + along_axes);
  }
  return out;
}

}  // namespace

CpuCut::CpuCut(CpuLattice& lattice, const Parallel& parallel, const simd::Kernels& kernels)
    : near_(lattice, tissueReaches(lattice), parallel, kernels) {
  changed_.reserve(lattice.store.active.size());
}

/// Finds in parallel which nodes lose springs. Then removes these one by one, as this writes sides that other nodes
/// read.
template <class Kernel>
uint32_t CpuCut::cutWith(CpuLattice& lattice, const layout::ToolMotion& motion, const uint8_t* spared) {
  Kernel kernel(lattice);
  kernel.tool_motions = &motion;
  kernel.near = &near_;
  near_.keep(lattice, [&](uint32_t slot) {
    return spared && spared[lattice.store.nodes[slot].hi >> layout::kBodyShift] ? 0 : kernel.loses(slot);
  });
  for (uint32_t brick : near_.bricks()) {
    if (near_.nodes(brick) == 0) continue;
    for (uint32_t i = lattice.store.first_active[brick]; i < lattice.store.first_active[brick + 1]; ++i) {
      const uint32_t slot = lattice.store.active[i];
      if (!(near_.nodes(brick) >> slot % layout::kBrickSlots & 1)) continue;
      kernel.index = i;
      kernel.main();
      lattice.refresh(slot);
      changed_.push_back(slot);
    }
  }
  return kernel.stats.springs_cut;
}

template <class Springs, class Particles>
uint32_t CpuCut::cutAll(CpuLattice& lattice, const layout::ToolMotion& motion, bool particles, const uint8_t* spared) {
  return particles ? cutWith<Particles>(lattice, motion, spared) : cutWith<Springs>(lattice, motion, spared);
}

void CpuCut::tearCells(CpuLattice& lattice) const {
  if (lattice.strengths.bulk.empty()) return;
  glsl::TearCell kernel(lattice);
  kernel.cell_count = 1;
  for (uint32_t slot : changed_) {
    for (int c = 0; c < 8; ++c) {
      bool exists;
      const uint32_t cell = kernel.cellAt(slot, 2 * glsl::ivec3(c & 1, c >> 1 & 1, c >> 2 & 1) - 1, exists);
      if (!exists || !(lattice.store.nodes[cell].lo & layout::kCellBit)) continue;
      kernel.cells = &cell;
      kernel.main();
      lattice.refresh(cell);
    }
  }
}

uint32_t CpuCut::run(CpuLattice& lattice, const layout::ToolMotion& motion, bool particles, const uint8_t* spared,
                     bool at_rest) {
  near_.find(lattice, motion, particles, at_rest);
  changed_.clear();
  const bool records = !lattice.axial_cut.empty();
  return records ? cutAll<glsl::CutSprings, glsl::CutParticles>(lattice, motion, particles, spared)
                 : cutAll<glsl::CutSpringsForgetting, glsl::CutParticlesForgetting>(lattice, motion, particles, spared);
}

}  // namespace viscera
