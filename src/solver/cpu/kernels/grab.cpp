// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/kernels/glsl_kernel.h"
#include "solver/cpu/kernels/tool_passes.h"

namespace viscera {

namespace glsl {

namespace {

struct GrabKernel : Kernel {
  using Kernel::Kernel;
  uint stylus = 0;
  vec4 tip = vec4(0), orientation = vec4(0);
  float release_speed = 0, above = -1;
  TickStats stats{};
};

#define VARIANT_NAME TakeHold
#define VARIANT_BASE GrabKernel
#define VARIANT_TEXT "shaders/solver/tools/grab.comp"
#include "solver/cpu/kernels/glsl_variant.inc"

#define VARIANT_NAME LetGo
#define VARIANT_BASE GrabKernel
#define VARIANT_TEXT "shaders/solver/tools/grab.comp"
#define VARIANT_FEATURES WITH_RELEASE
#include "solver/cpu/kernels/glsl_variant.inc"

}  // namespace

}  // namespace glsl

namespace {

/// Runs a kernel that may change the bits of any node.
template <class Kernel>
void runOnAll(CpuLattice& lattice, Kernel& kernel) {
  for (uint32_t i = 0; i < lattice.store.active.size(); ++i) {
    const uint32_t slot = lattice.store.active[i], before = lattice.store.nodes[slot].lo;
    kernel.index = i;
    kernel.main();
    if (lattice.store.nodes[slot].lo != before) lattice.refresh(slot);
  }
}

}  // namespace

void takeHold(CpuLattice& lattice, uint32_t stylus, const Pose& pose, double radius_m) {
  glsl::TakeHold kernel(lattice);
  kernel.stylus = stylus;
  const Vector3f tip = pose.position_m.cast<float>();
  const Eigen::Vector4f q = pose.orientation.coeffs().cast<float>();  // xyzw
  kernel.tip = glsl::vec4(tip.x(), tip.y(), tip.z(), static_cast<float>(radius_m));
  kernel.orientation = glsl::vec4(q.x(), q.y(), q.z(), q.w());
  runOnAll(lattice, kernel);
}

void letGo(CpuLattice& lattice, uint32_t stylus, const Release& release, const layout::TickStats& stats) {
  glsl::LetGo kernel(lattice);
  kernel.stylus = stylus;
  kernel.release_speed = static_cast<float>(release.speed_m_per_s);
  kernel.above = static_cast<float>(release.above_n_s);
  kernel.stats = stats;
  runOnAll(lattice, kernel);
}

}  // namespace viscera
