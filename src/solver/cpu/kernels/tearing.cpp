// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/kernels/tearing.h"

#include <algorithm>
#include <cmath>

#include "solver/cpu/kernels/glsl_kernel.h"

namespace viscera {

namespace glsl {

namespace {

struct CellKernel : Kernel {
  using Kernel::Kernel;
  uint cell_count = 1;
};

#define VARIANT_NAME TornCell
#define VARIANT_BASE CellKernel
#define VARIANT_TEXT "shaders/solver/tissue/cell_forces.comp"
#define VARIANT_FEATURES WITH_CUT
#include "solver/cpu/kernels/glsl_variant.inc"

}  // namespace

}  // namespace glsl

namespace {

constexpr double kWatched = 0.6;    // share of the strain at onset from which a brick is watched: it may tear in a tick
constexpr double kLeast = 1e-3;     // least step by which a spring softens
constexpr float kTornShare = 0.5f;  // position of walls along a torn spring
constexpr uint32_t kCellsAround = 8;

void sortOnce(std::vector<uint32_t>& slots) {
  std::sort(slots.begin(), slots.end());
  slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
}

}  // namespace

CpuTearing::CpuTearing(const Model& model) {
  for (const Body& body : model.bodies) {
    laws_.emplace_back();
    if (tears(body)) laws_.back() = tearLawOf(body);
  }
}

void CpuTearing::beginTick(const CpuLattice& lattice, const std::vector<simd::BrickStats>& stats) {
  bricks_.clear();
  for (uint32_t b = 0; b < stats.size(); ++b) {
    const std::optional<TearLaw>& law = laws_[lattice.store.bricks[b].body];
    if (law && static_cast<double>(stats[b].max_stretch) > kWatched * law->onset_strain) bricks_.push_back(b);
  }
}

uint32_t CpuTearing::run(CpuLattice& lattice) {
  if (bricks_.empty()) return 0;
  changed_.clear();
  glsl::TornCell kernel(lattice);
  uint32_t parted = 0;
  for (const uint32_t brick : bricks_) {
    const TearLaw& law = *laws_[lattice.store.bricks[brick].body];
    for (uint32_t i = lattice.store.first_active[brick]; i < lattice.store.first_active[brick + 1]; ++i)
      parted += stretch(lattice, kernel, lattice.store.active[i], law);
  }
  if (!changed_.empty()) refresh(lattice, kernel);
  return parted;
}

/// Softens the even springs of a node.
/// @return number of springs that have torn
template <class Kernel>
uint32_t CpuTearing::stretch(CpuLattice& lattice, Kernel& kernel, uint32_t slot, const TearLaw& law) {
  const float* const u = lattice.state.displacement[lattice.state.current].data();
  const double h = static_cast<double>(lattice.store.bodyOf(slot).origin_spacing.w);
  const Vector3f own = planesAt(u, slot);
  uint32_t parted = 0;
  for (uint32_t pair = 0; pair < kSpringPairs; ++pair) {
    if (springCount(lattice.store.nodes[slot], 2 * pair) == 0) continue;
    const auto& o = kNeighborOffsets[2 * pair];
    const uint32_t other = kernel.neighborSlot(slot, glsl::ivec3(o[0], o[1], o[2]));
    const Vector3d rest_m = h * Vector3d(o[0], o[1], o[2]);
    const double extension_m = (rest_m + (planesAt(u, other) - own).cast<double>()).norm() - rest_m.norm();
    const bool axial = isAxial(2 * pair);
    if (extension_m <= law.springs[axial ? 0 : 1].onset_m) continue;
    const double left = law.left(axial, extension_m);
    float& kept = lattice.strengths.left[stiffnessAt(slot, pair)];
    if (left > 0 && left > static_cast<double>(kept) - kLeast) continue;
    kept = static_cast<float>(left);
    changed_.push_back(slot);
    changed_.push_back(other);
    if (left > 0) continue;
    ++parted;
    lattice.store.nodes[slot] = kernel.withoutSpring(lattice.store.nodes[slot], 2 * pair);
    lattice.store.nodes[other] = kernel.withoutSpring(lattice.store.nodes[other], 2 * pair + 1);
    if (axial) lattice.axial_cut[3 * slot + pair] = kTornShare;
  }
  return parted;
}

/// Updates the nodes with changed springs, and the cells around them.
template <class Kernel>
void CpuTearing::refresh(CpuLattice& lattice, Kernel& kernel) {
  sortOnce(changed_);
  for (const uint32_t slot : changed_) lattice.refresh(slot);
  if (lattice.strengths.bulk.empty()) return;
  cells_.clear();
  for (const uint32_t slot : changed_) {
    for (uint32_t c = 0; c < kCellsAround; ++c) {
      bool exists;
      const uint32_t cell = kernel.cellAt(slot, 2 * glsl::ivec3(c & 1, c >> 1 & 1, c >> 2 & 1) - 1, exists);
      if (exists && (lattice.store.nodes[cell].lo & layout::kCellBit)) cells_.push_back(cell);
    }
  }
  sortOnce(cells_);
  for (const uint32_t& cell : cells_) {
    kernel.cells = &cell;
    kernel.main();
    lattice.refresh(cell);
  }
}

}  // namespace viscera
