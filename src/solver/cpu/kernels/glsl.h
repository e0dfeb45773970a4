// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <glm/common.hpp>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <glm/vector_relational.hpp>

#include "layout.h"

// The vocabulary of GLSL in C++. Shaders are compiled for the CPU as members of a class that provides their buffers and
// uniforms (glsl_kernel.h, glsl_variant.inc). Compile with -ffp-contract=off: both ends of a spring must compute the
// same bits.

namespace viscera::glsl {

using namespace layout;  // GLM's vectors hide its vectors
using glm::dvec4;
using glm::ivec3;
using glm::uvec3;
using glm::uvec4;
using glm::vec2;
using glm::vec3;
using glm::vec4;

using glm::abs;
using glm::all;
using glm::clamp;
using glm::cross;
using glm::distance;
using glm::dot;
using glm::floatBitsToUint;
using glm::floor;
using glm::greaterThanEqual;
using glm::inversesqrt;
using glm::length;
using glm::lessThanEqual;
using glm::max;
using glm::min;
using glm::mix;
using glm::normalize;
using glm::notEqual;
using glm::sqrt;
using glm::uintBitsToFloat;

/// Returns a * b + c with both operations rounded: a fused one is a call into the C library if the processor may lack
/// it.
inline float fma(float a, float b, float c) {
  return a * b + c;
}
inline vec3 xyz(const vec4& v) {
  return vec3(v);
}
inline vec3 xyz(const layout::vec4& v) {
  return {v.x, v.y, v.z};
}
inline vec4 xyzw(const layout::vec4& v) {
  return {v.x, v.y, v.z, v.w};
}

using Word = std::atomic<uint>;  ///< of a buffer that invocations write concurrently

inline void atomicMax(Word& word, uint value) {
  uint now = word.load(std::memory_order_relaxed);
  while (now < value && !word.compare_exchange_weak(now, value, std::memory_order_relaxed)) {
  }
}
inline void atomicAdd(uint& sum, uint value) {
  sum += value;
}
inline void atomicAnd(uint& bits, uint value) {
  bits &= value;
}
inline void atomicOr(uint& bits, uint value) {
  bits |= value;
}
inline void atomicMax(uint& word, uint value) {
  word = max(word, value);
}

}  // namespace viscera::glsl
