// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/kernels/near_links.h"

#include <algorithm>
#include <cmath>

#include "layout/blade.h"
#include "solver/cpu/kernels/glsl_kernel.h"
#include "solver/cpu/kernels/near_blade.h"

namespace viscera {

namespace glsl {

namespace {

#define VARIANT_NAME Nodes
#define VARIANT_BASE Kernel
#define VARIANT_TEXT "shaders/solver/tissue/lattice.glsl"
#include "solver/cpu/kernels/glsl_variant.inc"

}  // namespace

}  // namespace glsl

namespace {

constexpr size_t kNodesPerJob = 512;

/// Margin over the size of the box, some hundred times the rounding error of a float.
constexpr float kRounding = 1e-5f;

size_t jobsOf(const std::vector<uint32_t>& slots) {
  return (slots.size() + kNodesPerJob - 1) / kNodesPerJob;
}

std::vector<float> reaches(CpuLattice& lattice, const std::vector<uint32_t>& slots) {
  std::vector<float> out(lattice.slotCount());
  glsl::Nodes nodes(lattice);
  for (const uint32_t slot : slots) {
    if (nodes.surfaceOffset(slot) != 0)
      out[slot] = layout::kFarthestTissue * lattice.store.bodyOf(slot).origin_spacing.w;
  }
  return out;
}

}  // namespace

float NearLinks::fastest(const CpuLattice& lattice, const std::vector<uint32_t>& slots) {
  const float* v = lattice.state.velocity[lattice.state.current].data();
  parallel_(jobsOf(slots), [&](size_t job) {
    float largest = 0;
    for (size_t i = job * kNodesPerJob; i < std::min(slots.size(), (job + 1) * kNodesPerJob); ++i)
      largest = std::max(largest, planesAt(v, slots[i]).squaredNorm());
    fastest2_[job] = largest;
  });
  return std::sqrt(*std::max_element(fastest2_.begin(), fastest2_.end()));
}

void NearLinks::find(CpuLattice& lattice, const std::vector<uint32_t>& slots, const layout::ToolMotion& m) {
  if (slots.empty()) return;
  if (outside_.empty()) {
    reach_m_ = reaches(lattice, slots);
    outside_.resize(lattice.slotCount());
    fastest2_.resize(jobsOf(slots));
  }
  const glsl::vec3 from = glsl::xyz(m.from), tip = glsl::xyz(m.to) - from;
  const glsl::vec3 far_from = glsl::xyz(m.blade_from) - from, far_to = glsl::xyz(m.blade_to) - from;
  const glsl::vec3 low = glsl::min(glsl::min(glsl::vec3(0.0f), tip), glsl::min(far_from, far_to));
  const glsl::vec3 high = glsl::max(glsl::max(glsl::vec3(0.0f), tip), glsl::max(far_from, far_to));
  // A spring sees the sweep begin where it was itself a substep ago; an eraser reaches blade_from.w farther.
  const float moved = m.timing.x * fastest(lattice, slots) + layout::kOverlap * glsl::length(tip);
  const float rounding = kRounding * (glsl::length(high - low) + glsl::length(from));
  const float grown = moved + m.blade_from.w + rounding;
  glsl::Nodes nodes(lattice);
  parallel_(jobsOf(slots), [&](size_t job) {
    for (size_t i = job * kNodesPerJob; i < std::min(slots.size(), (job + 1) * kNodesPerJob); ++i) {
      const uint32_t slot = slots[i];
      const glsl::vec3 at = (nodes.restPosition(slot) - from) + glsl::xyz(nodes.displacement[slot]);
      const float reach = grown + reach_m_[slot];
      int sides = 0;  // positions that are not finite are beyond none
      for (int k = 0; k < 3; ++k)
        sides |= (at[k] + reach < low[k]) << (2 * k) | (at[k] - reach > high[k]) << (2 * k + 1);
      outside_[slot] = static_cast<uint8_t>(sides);
    }
  });
}

}  // namespace viscera
