// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "solver/cpu/glsl_kernel.h"

namespace viscera::glsl {

using glm::floor;

/// A key of GW's search, as uvec2 on the GPU.
struct Item {
  uint x = 0, y = 0;
  bool operator<(const Item& other) const { return x != other.x ? x < other.x : y < other.y; }
};

/// What the texts of shaders/solver/collision_*.comp find in buffers and uniforms.
struct CollisionKernel : Kernel {
  using Kernel::Kernel;
  float cell_m = 1, friction = 0, restitution = 0;
  uint bucket_count = 1, partitions = 1, window = 0, sorted_count = 0;
  const uint* collidable = nullptr;
  const layout::vec4* body_influences = nullptr;
  vec4 *contacts = nullptr, *corrections = nullptr;
  const uint *buckets = nullptr, *ranks = nullptr;
  const uvec4* entries = nullptr;
  const vec4* entries_before = nullptr;
  const Item* items = nullptr;
};

/// Which nodes may touch others, and how near: no stage, only what all of them know.
#define VARIANT_NAME CollisionRules
#define VARIANT_BASE CollisionKernel
#define VARIANT_TEXT "shaders/solver/collision_search.glsl"
#include "solver/cpu/glsl_variant.inc"

}  // namespace viscera::glsl
