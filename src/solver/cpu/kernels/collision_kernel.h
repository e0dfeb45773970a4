// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/cpu/kernels/glsl_kernel.h"

namespace viscera::glsl {

using glm::floor;

/// Buffers of shader texts with contacts between nodes in implicit substeps
/// (shaders/solver/implicit/implicit_pairs.glsl).
struct PairBuffers {
  uint* pair_words = nullptr;
  vec4 *pair_rows = nullptr, *node_pairs = nullptr;
  uint pair_slots = 0, most_pairs = 0;
  float pair_friction = 0, pair_restitution = 0, pair_bounces_from = 0;
  uint takeRoom(uint count) const {
    const uint first = pair_words[0];  // one thread
    pair_words[0] += count;
    return first;
  }
};

/// Buffers and uniforms of the texts of shaders/solver/collision/*.comp.
struct CollisionKernel : Kernel, PairBuffers {
  using Kernel::Kernel;
  const vec4* increment = nullptr;  // within an implicit substep: contacts are tested at the displaced positions
  vec4* increments = nullptr;       // the same buffer, writable
  float widened = 1, cell_m = 1, friction = 0, restitution = 0;
  uint bucket_count = 1;
  const float* touch_depths = nullptr;
  const layout::vec4* body_influences = nullptr;
  vec4 *contacts = nullptr, *corrections = nullptr;
  const uint* buckets = nullptr;
  const uvec4* entries = nullptr;
  const vec4* entries_before = nullptr;
};

/// The rules of contact: which nodes may touch others, and at which distance. Not a stage of its own.
#define VARIANT_NAME CollisionRules
#define VARIANT_BASE CollisionKernel
#define VARIANT_TEXT "shaders/solver/collision/collision_search.glsl"
#include "solver/cpu/kernels/glsl_variant.inc"

}  // namespace viscera::glsl
