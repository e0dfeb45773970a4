// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
// clang-format off
// Types and macros for the memory layouts in this folder, which are valid as GLSL 4.50 (std430, std140) and as C++17. In C++
// everything is in namespace viscera::layout.
#ifndef VISCERA_LAYOUT_TYPES_H
#define VISCERA_LAYOUT_TYPES_H

#ifdef __cplusplus
#include <cstdint>
#include <viscera/api.h>  // not in quotes: GLSL would be given it
namespace VISCERA_PUBLIC viscera { namespace layout {
using uint = std::uint32_t;
struct alignas(16) vec4 {
  float x, y, z, w;
};
struct alignas(16) uvec4 {
  uint x, y, z, w;
};
struct alignas(16) ivec4 {
  int x, y, z, w;
};
}}  // namespace viscera::layout
#else
// Syntax that differs where the CPU backend compiles GLSL as C++ (src/solver/cpu/kernels/glsl.h).
#define INOUT(T) inout T
#define OUT(T) out T
#define xyz(v) (v).xyz
#define xyzw(v) (v)
#endif
#endif
