// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Vectors of nodes for the SIMD kernels, and the leapfrog step of a node. Included once per instruction set (Highway).
#if defined(VISCERA_SOLVER_CPU_VECTORS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef VISCERA_SOLVER_CPU_VECTORS_INL_H
#undef VISCERA_SOLVER_CPU_VECTORS_INL_H
#else
#define VISCERA_SOLVER_CPU_VECTORS_INL_H
#endif

#include "hwy/highway.h"
#include "solver/tissue/substep.h"
#include "viscera/layout/nodes.h"

HWY_BEFORE_NAMESPACE();
namespace viscera::simd::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using Tag = hn::CappedTag<float, 16>;
using V = hn::Vec<Tag>;
using M = hn::Mask<Tag>;

HWY_INLINE V load(const float* at) {
  return hn::LoadU(Tag(), at);
}
HWY_INLINE V set(float value) {
  return hn::Set(Tag(), value);
}

// For a spring of length L and rest length l0, q = (L^2 - l0^2) / l0^2 and (L - l0)/L = q phi(q) with phi(q) = 1 / (1 +
// q + sqrt(1 + q)). For |q| < kMild, phi is a polynomial of degree 5 with a relative error of at most 5.2e-8.
const float kMild = layout::kMildStretch;
constexpr float kPhi[6] = {0.500000026f, -0.375000048f, 0.312470624f, -0.273403791f, 0.251082405f, -0.230579299f};
HWY_INLINE V mildPhi(V q) {
  V p = set(kPhi[5]);
  for (int i = 4; i >= 0; --i) p = hn::MulAdd(p, q, set(kPhi[i]));
  return p;
}
struct Vec3 {
  V x, y, z;
};
HWY_INLINE V component(const Vec3& v, int c) {
  return c == 0 ? v.x : c == 1 ? v.y : v.z;
}
HWY_INLINE Vec3 operator-(const Vec3& a, const Vec3& b) {
  return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
HWY_INLINE Vec3 operator+(const Vec3& a, const Vec3& b) {
  return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
HWY_INLINE Vec3 operator*(V a, const Vec3& b) {
  return {hn::Mul(a, b.x), hn::Mul(a, b.y), hn::Mul(a, b.z)};
}
HWY_INLINE V dot(const Vec3& a, const Vec3& b) {
  return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
}
/// Returns a + s b.
HWY_INLINE Vec3 mulAdd(V s, const Vec3& b, const Vec3& a) {
  return {hn::MulAdd(s, b.x, a.x), hn::MulAdd(s, b.y, a.y), hn::MulAdd(s, b.z, a.z)};
}
HWY_INLINE Vec3 cross(const Vec3& a, const Vec3& b) {
  return {hn::MulSub(a.y, b.z, hn::Mul(a.z, b.y)), hn::MulSub(a.z, b.x, hn::Mul(a.x, b.z)),
          hn::MulSub(a.x, b.y, hn::Mul(a.y, b.x))};
}
HWY_INLINE Vec3 select(M mask, const Vec3& yes, const Vec3& no) {
  return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y), hn::IfThenElse(mask, yes.z, no.z)};
}
HWY_INLINE Vec3 zero3() {
  const V zero = hn::Zero(Tag());
  return {zero, zero, zero};
}
HWY_INLINE Vec3 loadPlanes(const float* at) {
  return {load(at), load(at + 64), load(at + 128)};
}
HWY_INLINE void storePlanes(const Vec3& value, float* at) {
  hn::StoreU(value.x, Tag(), at);
  hn::StoreU(value.y, Tag(), at + 64);
  hn::StoreU(value.z, Tag(), at + 128);
}

/// Returns the rest positions of a vector's nodes [m].
/// @param from  rest position of the brick's first slot
/// @param i  index of the vector's first node
HWY_INLINE Vec3 restOf(const float (&from)[3], float h, int i) {
  alignas(64) static constexpr float kX[16] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
  alignas(64) static constexpr float kY[16] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};
  const V spacing = set(h);
  return {hn::MulAdd(spacing, load(kX), set(from[0])), hn::MulAdd(spacing, load(kY + (i & 15)), set(from[1])),
          set(from[2] + h * static_cast<float>(i >> 4))};
}

/// Returns sum + increment, with Kahan's compensation if there is memory for it (shaders/solver/step/leapfrog.comp).
HWY_INLINE Vec3 added(float* compensation, size_t at, const Vec3& sum, const Vec3& increment) {
  if (!compensation) return sum + increment;
  const Vec3 all_of_it = increment - loadPlanes(compensation + at);
  const Vec3 next = sum + all_of_it;
  storePlanes((next - sum) - all_of_it, compensation + at);
  return next;
}

/// Constants of a substep, in all lanes.
struct Motion {
  V kick, drag2, per_drag, dt, sleep2;
  Vec3 gravity;
};

HWY_INLINE Motion motionOf(const Substep& step, const layout::BodyParams& body) {
  const float g = 0.5f * body.mass_damping_per_s * step.kick_s;
  const float far = step.sleep_distance_m;
  return {set(step.kick_s), set(2 * g),     set(1 / (1 + g)),
          set(step.dt_s),   set(far * far), {set(step.gravity.x()), set(step.gravity.y()), set(step.gravity.z())}};
}

/// Returns which nodes of a vector no stylus holds.
HWY_INLINE M areFree(const layout::NodeBits* nodes) {
  HWY_ALIGN float free[hn::MaxLanes(Tag())];
  for (size_t i = 0; i < hn::MaxLanes(Tag()); ++i) free[i] = (nodes[i].lo & layout::kGrabMask) != 0u ? 0.0f : 1.0f;
  return hn::Gt(hn::Load(Tag(), free), hn::Zero(Tag()));
}

/// Stops falling fragments at the distance sleep_distance_m (shaders/solver/tissue/sleep.glsl).
/// @param nodes  as for move()
HWY_INLINE void fallAsleep(const Motion& s, const layout::NodeBits* nodes, const Vec3& u, Vec3& u_next, Vec3& v_next) {
  const V away = dot(u_next, u_next);
  const M beyond = hn::Gt(away, s.sleep2);
  if (HWY_LIKELY(hn::AllFalse(Tag(), beyond))) return;
  const Vec3 leap = u_next - u;
  M falls = hn::And(hn::And(beyond, hn::Gt(away, dot(u, u))),
                    hn::Not(hn::Gt(dot(leap, leap), hn::Mul(set(0.01f), s.sleep2))));
  if (nodes) falls = hn::And(falls, areFree(nodes));
  u_next = select(falls, u, u_next);
  v_next = select(falls, zero3(), v_next);
}

/// Makes a leapfrog step (shaders/solver/step/leapfrog.comp).
/// @param mobility  1/kg, 0 where nothing moves
/// @param nodes  bits of the vector's first node; null where none can be held
/// @param near, speed  u and v before the step
/// @param lost  compensation of u, with that of v 192 farther; or null
HWY_INLINE void move(const Motion& s, V mobility, const layout::NodeBits* nodes, const Vec3& force, const Vec3& near,
                     const Vec3& speed, float* lost, Vec3& u_next, Vec3& v_next) {
  const M moves = hn::Gt(mobility, hn::Zero(Tag()));
  const Vec3 acceleration = mulAdd(mobility, force, s.gravity);
  // ((1 - g) v + kick a) / (1 + g), written as v and an increment.
  const Vec3 change = s.per_drag * mulAdd(hn::Neg(s.drag2), speed, s.kick * acceleration);
  v_next = added(lost, 192, speed, change);
  u_next = added(lost, 0, near, s.dt * v_next);
  fallAsleep(s, nodes, near, u_next, v_next);
  u_next = select(moves, u_next, near);
  v_next = select(moves, v_next, zero3());
}

/// Returns whether the bits of all rows of a vector are 0.
/// @param rows  bit r: the four nodes from 4 r on
/// @param i  index of the vector's first node
HWY_INLINE bool noRows(uint32_t rows, int i) {
  constexpr uint32_t kRows = (1u << (hn::MaxLanes(Tag()) / 4)) - 1;
  return (rows >> (i / 4) & kRows) == 0;
}

}  // namespace viscera::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
