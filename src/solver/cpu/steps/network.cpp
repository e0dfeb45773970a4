// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/steps/network.h"

#include <algorithm>

#include "layout/blade.h"
#include "math/archive.h"
#include "math/float_bits.h"
#include "solver/cpu/steps/cpu_device.h"

namespace viscera {

namespace glsl {

namespace {

#define VARIANT_NAME Position
#define VARIANT_BASE Kernel
#define VARIANT_TEXT "shaders/solver/tissue/lattice.glsl"
#include "solver/cpu/kernels/glsl_variant.inc"

/// Storage of a node's energies in one place, whatever the index of the invocation.
struct OneNode {
  vec2 sum = vec2(0);
  vec2& operator[](uint) { return sum; }
};

struct MeasuringKernel : Kernel {
  using Kernel::Kernel;
  uint count = 0;
  TickStats stats{};
  OneNode energies;
};

#define VARIANT_NAME Measure
#define VARIANT_BASE MeasuringKernel
#define VARIANT_TEXT "shaders/solver/step/measure.comp"
#define VARIANT_FEATURES WITH_DASHPOT
#include "solver/cpu/kernels/glsl_variant.inc"

struct CutKernel : Kernel {
  explicit CutKernel(CpuLattice& lattice)
      : Kernel(lattice),
        springs(lattice.links.network.springs.data()),
        links(lattice.links.network.links.data()),
        spring_cut(lattice.links.spring_cut.data()),
        spring_count(static_cast<uint>(lattice.links.network.springs.size())) {}
  const SpringEnds* springs;
  Link* links;
  float* spring_cut;
  uint spring_count, stylus = 0;
  struct {
    uint springs_cut = 0;
  } stats;
};

#define VARIANT_NAME CutLinks
#define VARIANT_BASE CutKernel
#define VARIANT_TEXT "shaders/solver/tools/cut_links.comp"
#include "solver/cpu/kernels/glsl_variant.inc"

#define VARIANT_NAME CutLinksOfParticles
#define VARIANT_BASE CutKernel
#define VARIANT_TEXT "shaders/solver/tools/cut_links.comp"
#define VARIANT_FEATURES WITH_PARTICLES
#include "solver/cpu/kernels/glsl_variant.inc"

}  // namespace

}  // namespace glsl

namespace {

/// Cuts links.
/// @param may_lose  (slot, slot): returns whether the spring between them may be cut
template <class Kernel, class MayLose>
uint32_t cutWith(CpuLattice& lattice, const layout::ToolMotion& motion, const MayLose& may_lose) {
  Kernel kernel(lattice);
  kernel.tool_motions = &motion;
  for (uint32_t i = 0; i < kernel.spring_count; ++i) {
    if (!may_lose(kernel.springs[i].a, kernel.springs[i].b)) continue;
    kernel.index = i;
    kernel.main();
  }
  return kernel.stats.springs_cut;
}

void takeLarger(uint32_t& bits, uint32_t other) {
  bits = std::max(bits, other);  // positive floats sort like their bits
}

template <class Kernel>
void measureWith(CpuLattice& lattice, const std::vector<uint32_t>& slots, layout::TickStats& stats) {
  Kernel kernel(lattice);
  kernel.active_nodes = slots.data();
  kernel.count = static_cast<uint32_t>(slots.size());
  double kinetic_j = 0, elastic_j = 0;
  for (size_t i = 0; i < slots.size(); ++i) {
    runRange(kernel, i, i + 1);
    kinetic_j += static_cast<double>(kernel.energies.sum.x);
    elastic_j += static_cast<double>(kernel.energies.sum.y);
  }
  stats.kinetic_j += static_cast<float>(kinetic_j);
  stats.elastic_j += static_cast<float>(elastic_j);
  stats.nonfinite += kernel.stats.nonfinite;
  stats.collapsed += kernel.stats.collapsed;
  stats.inverted += kernel.stats.inverted;
  takeLarger(stats.max_stretch_bits, kernel.stats.max_stretch_bits);
  takeLarger(stats.max_speed_bits, kernel.stats.max_speed_bits);
  takeLarger(stats.max_rate_bits, kernel.stats.max_rate_bits);
}

constexpr Portions kGroupsPerStep{2, 16};      // per step: some 10 us of work at most
constexpr Portions kGroupsPerSpread{64, 512};  // likewise

std::vector<uint32_t> groupsOf(const std::vector<uint32_t>& slots) {
  std::vector<uint32_t> out;
  for (const uint32_t slot : slots) {
    const auto group = static_cast<uint32_t>(slot / simd::kGroupNodes);
    if (out.empty() || out.back() != group) out.push_back(group);
  }
  return out;
}

}  // namespace

CpuNetwork::CpuNetwork(const CpuLattice& lattice, const Parallel& parallel, const FeatureSet& features,
                       const simd::Kernels& kernels)
    : parallel_(parallel),
      spread_rows_(kernels.spread_network),
      step_rows_(kernels.leapfrog_network),
      dashpot_(features.dashpot),
      near_(parallel) {
  if (lattice.links.network.starts.empty()) return;
  for (const uint32_t slot : lattice.store.active) {
    if (lattice.connections(slot) != layout::kImplicit) slots_.push_back(slot);
  }
  touched_.reserve(slots_.size());
  rows_ = simd::LinkRows(lattice.links.network, groupsOf(slots_));
  positions_.resize(4 * lattice.slotCount());
  if (dashpot_) speeds_.resize(4 * lattice.slotCount());
}

void CpuNetwork::restart(const CpuLattice& lattice) {
  rows_.writeStiffness(lattice.links.network.links);
}

void CpuNetwork::step(CpuLattice& lattice, const Substep& step, AlignedVector<float>& compensation) {
  simd::NetworkJob job{};
  job.rows = &rows_;
  job.step = step;
  job.dashpot = dashpot_;
  job.bricks = lattice.store.bricks.data();
  job.bodies = lattice.store.bodies.data();
  job.displacement = lattice.state.displacement[lattice.state.current].data();
  job.velocity = lattice.state.velocity[lattice.state.current].data();
  job.next_displacement = lattice.state.displacement[1 - lattice.state.current].data();
  job.next_velocity = lattice.state.velocity[1 - lattice.state.current].data();
  job.compensation = compensation.empty() ? nullptr : compensation.data();
  job.mobility = lattice.strengths.mobility.data();
  job.nodes = lattice.store.nodes.data();
  job.positions = positions_.data();
  job.speeds = speeds_.data();
  const auto ofAll = [&](simd::NetworkGroups kernel, Portions portions) {
    parallel_.ranges(rows_.groups.size(), portions, [&](size_t first, size_t end) { kernel(job, first, end); });
  };
  ofAll(spread_rows_, kGroupsPerSpread);
  ofAll(step_rows_, kGroupsPerStep);
}

/// Returns the vector to x from the nearest point of a sphere's center or a capsule's axis.
static glsl::vec3 fromReach(const simd::Reach& reach, const glsl::vec3& x) {
  const glsl::vec3 axis(reach.axis_m[0], reach.axis_m[1], reach.axis_m[2]);
  const glsl::vec3 off = x - glsl::vec3(reach.center_m[0], reach.center_m[1], reach.center_m[2]);
  return off - glsl::clamp(glsl::dot(off, axis) * reach.inverse_length2, 0.0f, 1.0f) * axis;
}

const std::vector<uint32_t>& CpuNetwork::touched(CpuLattice& lattice, const std::vector<simd::Reach>& reaches) {
  touched_.clear();
  glsl::Position position(lattice);
  for (uint32_t slot : slots_) {
    if (lattice.strengths.mobility[slot] == 0) continue;
    bool near = (lattice.store.nodes[slot].lo & layout::kGrabMask) != 0;
    if (!near) {
      const glsl::vec3 x = position.restPosition(slot) + glsl::xyz(position.next_displacement[slot]);
      for (const simd::Reach& reach : reaches) {
        const glsl::vec3 away = fromReach(reach, x);
        near |= glsl::dot(away, away) < reach.radius_m * reach.radius_m;
      }
    }
    if (near) touched_.push_back(slot);
  }
  return touched_;
}

void CpuNetwork::measure(CpuLattice& lattice, layout::TickStats& stats) const {
  measureWith<glsl::Measure>(lattice, slots_, stats);
}

uint32_t CpuNetwork::cut(CpuLattice& lattice, const layout::ToolMotion& motion, bool particles, const uint8_t* spared) {
  near_.find(lattice, slots_, motion);
  const auto may_cross = [&](uint32_t a, uint32_t b) {
    return near_.mayCross(a, b) && !(spared && spared[lattice.store.nodes[a].hi >> layout::kBodyShift]);
  };
  const auto may_erase = [this](uint32_t a, uint32_t b) { return near_.mayErase(a, b); };
  const uint32_t springs = particles ? cutWith<glsl::CutLinksOfParticles>(lattice, motion, may_erase)
                                     : cutWith<glsl::CutLinks>(lattice, motion, may_cross);
  if (springs == 0) return 0;
  for (const uint32_t slot : slots_) lattice.refresh(slot);
  rows_.writeStiffness(lattice.links.network.links);
  return springs;
}

}  // namespace viscera
