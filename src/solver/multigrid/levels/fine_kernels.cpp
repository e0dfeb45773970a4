// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/multigrid/levels/fine_kernels.h"

#include <string>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/multigrid/levels/fine_kernels.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "solver/cpu/simd/springs-inl.h"
#include "solver/cpu/simd/targets.h"
#include "solver/multigrid/levels/fine_cells-inl.h"

HWY_BEFORE_NAMESPACE();
namespace viscera::simd::HWY_NAMESPACE {

/// Calls APPLY(pair, x, y, z) for the springs that a node owns.
#define VISCERA_PAIRS(APPLY) \
  APPLY(0, 1, 0, 0)          \
  APPLY(1, 0, 1, 0)          \
  APPLY(2, 0, 0, 1)          \
  APPLY(3, 1, 1, 0) APPLY(4, 1, -1, 0) APPLY(5, 1, 0, 1) APPLY(6, 1, 0, -1) APPLY(7, 0, 1, 1) APPLY(8, 0, 1, -1)

/// A symmetric block, summed.
struct Symmetric {
  V xx, xy, xz, yy, yz, zz;
};
HWY_INLINE void addSquare(const Vec3& s, Symmetric& to) {
  to.xx = hn::MulAdd(s.x, s.x, to.xx);
  to.xy = hn::MulAdd(s.x, s.y, to.xy);
  to.xz = hn::MulAdd(s.x, s.z, to.xz);
  to.yy = hn::MulAdd(s.y, s.y, to.yy);
  to.yz = hn::MulAdd(s.y, s.z, to.yz);
  to.zz = hn::MulAdd(s.z, s.z, to.zz);
}
HWY_INLINE void addIdentity(V t, Symmetric& to) {
  to.xx = hn::Add(to.xx, t);
  to.yy = hn::Add(to.yy, t);
  to.zz = hn::Add(to.zz, t);
}

/// Force and tangent of a spring, seen from its near end.
struct LinearSpring {
  Vec3 force, s;
  V t, energy;
};
template <bool kTangent, int X, int Y, int Z>
HWY_INLINE LinearSpring linearSpring(const Material& m, float damping_rate, V k, const Vec3& w, const Vec3& dv) {
  constexpr int kKind = X * X + Y * Y + Z * Z - 1;
  const V none = hn::Zero(Tag()), one = set(1);
  const V q = hn::IfThenElseZero(hn::Gt(k, none), hn::Mul(dot(w, shifted<X, Y, Z>(w, m.h2)), m.per_length2[kKind]));
  Vec3 e = shifted<X, Y, Z>(w, m.h);
  V phi = anyPhi(q);
  const M collapsed = hn::Lt(hn::Add(one, q), set(kShortest2));
  phi = hn::IfThenElse(collapsed, one, phi);
  e = select(collapsed, shifted<X, Y, Z>(zero3(), m.h), e);
  const V share = hn::Mul(q, phi);                                             // (L - l0) / L
  const V ratio = hn::IfThenElse(collapsed, one, hn::Sub(one, share));         // l0 / L
  const V per2 = hn::Mul(m.per_length2[kKind], hn::Mul(ratio, ratio));         // 1 / L^2
  const V dashpot = hn::Mul(m.dashpot_length2[kKind], hn::Mul(ratio, ratio));  // c / (k L^2)
  LinearSpring out;
  out.force = hn::Mul(k, hn::MulAdd(dot(dv, e), dashpot, share)) * e;
  if (kTangent) {
    const V across = hn::Max(none, share);  // what of k acts across the spring; never negative, as energies ask
    out.t = hn::Mul(k, across);
    // (1 + c rate / k - across) / L^2
    const V along = hn::MulAdd(hn::Sub(one, across), per2, hn::Mul(dashpot, set(damping_rate)));
    out.s = hn::Sqrt(hn::Mul(k, along)) * e;
  }
  const V stretch = hn::Div(share, ratio);  // (L - l0) / l0
  out.energy = hn::Div(hn::Mul(hn::Mul(set(0.5f), k), hn::Mul(stretch, stretch)), m.per_length2[kKind]);
  return out;
}

HWY_INLINE void invert(const Symmetric& d, V free, float* inverse, size_t places) {
  const V xx = hn::MulSub(d.yy, d.zz, hn::Mul(d.yz, d.yz)), xy = hn::MulSub(d.xz, d.yz, hn::Mul(d.xy, d.zz));
  const V xz = hn::MulSub(d.xy, d.yz, hn::Mul(d.xz, d.yy)), yy = hn::MulSub(d.xx, d.zz, hn::Mul(d.xz, d.xz));
  const V yz = hn::MulSub(d.xy, d.xz, hn::Mul(d.xx, d.yz)), zz = hn::MulSub(d.xx, d.yy, hn::Mul(d.xy, d.xy));
  const V det = hn::MulAdd(d.xx, xx, hn::MulAdd(d.xy, xy, hn::Mul(d.xz, xz)));
  const M good = hn::And(hn::Gt(det, hn::Zero(Tag())), hn::Gt(free, hn::Zero(Tag())));
  const V per = hn::IfThenElseZero(good, hn::Div(set(1), hn::IfThenElse(good, det, set(1))));
  const V numbers[6] = {xx, xy, xz, yy, yz, zz};
  for (size_t n = 0; n < 6; ++n) hn::StoreU(hn::Mul(per, numbers[n]), Tag(), inverse + n * places);
}

template <bool kTangent>
HWY_INLINE void evaluateNodesOf(const multigrid::FineArrays& a, const multigrid::Block* blocks, size_t count,
                                double* energy_j) {
  const size_t n = a.places;
  for (size_t b = 0; b < count; ++b) {
    const multigrid::Box& box = a.boxes[blocks[b].body];
    const Material m = materialOf(box.params);
    const float rate = box.damping_rate_per_s;
    V energy = hn::Zero(Tag());
    for (size_t i = blocks[b].at; i < blocks[b].at + multigrid::kBlock; i += hn::MaxLanes(Tag())) {
      const Vec3 near = loadOf(a.displacement, n, i), near_v = loadOf(a.velocity, n, i);
      const V inertia = load(a.diagonal + i), none = hn::Zero(Tag());
      Vec3 force = zero3();
      Symmetric d = {inertia, none, none, inertia, none, inertia};
#define VISCERA_LINEARISE(pair, X, Y, Z)                                                                             \
  {                                                                                                                  \
    const ptrdiff_t away = X + Y * box.row + Z * box.layer;                                                          \
    const size_t far = i + static_cast<size_t>(away), before = i - static_cast<size_t>(away);                        \
    const LinearSpring own =                                                                                         \
        linearSpring<kTangent, X, Y, Z>(m, rate, load(a.stiffness + (pair)*n + i),                                   \
                                        loadOf(a.displacement, n, far) - near, loadOf(a.velocity, n, far) - near_v); \
    energy = hn::Add(energy, own.energy);                                                                            \
    const LinearSpring other = linearSpring<kTangent, -(X), -(Y), -(Z)>(                                             \
        m, rate, load(a.stiffness + (pair)*n + before), loadOf(a.displacement, n, before) - near,                    \
        loadOf(a.velocity, n, before) - near_v);                                                                     \
    force = force + (own.force + other.force);                                                                       \
    if (kTangent) {                                                                                                  \
      uint16_t* const of_pair = a.tangent + (pair)*4 * n + i;                                                        \
      storeShort(own.s.x, of_pair);                                                                                  \
      storeShort(own.s.y, of_pair + n);                                                                              \
      storeShort(own.s.z, of_pair + 2 * n);                                                                          \
      storeShort(own.t, of_pair + 3 * n);                                                                            \
      addSquare(own.s, d);                                                                                           \
      addSquare(other.s, d);                                                                                         \
      addIdentity(hn::Add(own.t, other.t), d);                                                                       \
    }                                                                                                                \
  }
      VISCERA_PAIRS(VISCERA_LINEARISE)
#undef VISCERA_LINEARISE
      if (a.cells != multigrid::CellKind::kNone) {
        force = force + gatherCorners(a, box, i);
        if (kTangent) addVolumes(a, box, i, [&](const Vec3& s) HWY_ATTR { addSquare(s, d); });
      }
      storeTo(force, a.force, n, i);
      if (kTangent) invert(d, load(a.free + i), a.inverse + i, n);
    }
    *energy_j += static_cast<double>(hn::GetLane(hn::SumOfLanes(Tag(), energy)));
  }
}

void lineariseNodes(const multigrid::FineArrays& a, const multigrid::Block* blocks, size_t count, double* energy_j) {
  evaluateNodesOf<true>(a, blocks, count, energy_j);
}
void evaluateNodes(const multigrid::FineArrays& a, const multigrid::Block* blocks, size_t count, double* energy_j) {
  evaluateNodesOf<false>(a, blocks, count, energy_j);
}

/// A x of a vector of nodes.
HWY_INLINE Vec3 product(const multigrid::FineArrays& a, const multigrid::Box& box, const float* x, const Vec3& near,
                        size_t i) {
  const size_t n = a.places;
  Vec3 sum = load(a.diagonal + i) * near;
#define VISCERA_APPLY(pair, X, Y, Z)                                                            \
  {                                                                                             \
    const ptrdiff_t away = X + Y * box.row + Z * box.layer;                                     \
    const size_t before = i - static_cast<size_t>(away);                                        \
    const uint16_t* const of_pair = a.tangent + (pair)*4 * n;                                   \
    sum = sum + springTimes(of_pair, n, i, near - loadOf(x, n, i + static_cast<size_t>(away))); \
    sum = sum + springTimes(of_pair, n, before, near - loadOf(x, n, before));                   \
  }
  VISCERA_PAIRS(VISCERA_APPLY)
#undef VISCERA_APPLY
  if (a.cells != multigrid::CellKind::kNone) sum = sum - gatherCorners(a, box, i);
  return load(a.free + i) * sum;
}

/// A sum in float32 over a block, in float64 over all.
struct BlockSum {
  V lanes = hn::Zero(Tag());
  double* total;
  HWY_INLINE void add(V value) { lanes = hn::Add(lanes, value); }
  HWY_INLINE void close() {
    *total += static_cast<double>(hn::GetLane(hn::SumOfLanes(Tag(), lanes)));
    lanes = hn::Zero(Tag());
  }
};

void applyNodes(const multigrid::FineArrays& a, const float* x, float* y, bool subtract, const multigrid::Block* blocks,
                size_t count) {
  const size_t n = a.places;
  for (size_t b = 0; b < count; ++b) {
    for (size_t i = blocks[b].at; i < blocks[b].at + multigrid::kBlock; i += hn::MaxLanes(Tag())) {
      Vec3 sum = product(a, a.boxes[blocks[b].body], x, loadOf(x, n, i), i);
      if (subtract) sum = loadOf(y, n, i) - sum;
      storeTo(sum, y, n, i);
    }
  }
}

/// D^-1 r
HWY_INLINE Vec3 solved(const multigrid::FineArrays& a, const Vec3& r, size_t i) {
  const size_t n = a.places;
  const V xx = load(a.inverse + i), xy = load(a.inverse + n + i), xz = load(a.inverse + 2 * n + i);
  const V yy = load(a.inverse + 3 * n + i), yz = load(a.inverse + 4 * n + i), zz = load(a.inverse + 5 * n + i);
  return {dot({xx, xy, xz}, r), dot({xy, yy, yz}, r), dot({xz, yz, zz}, r)};
}

void smoothNodes(const multigrid::FineArrays& a, const multigrid::Smoothing& s, const multigrid::Block* blocks,
                 size_t count, double* sum) {
  const size_t n = a.places;
  BlockSum dots{hn::Zero(Tag()), sum};
  for (size_t b = 0; b < count; ++b) {
    for (size_t i = blocks[b].at; i < blocks[b].at + multigrid::kBlock; i += hn::MaxLanes(Tag())) {
      const Vec3 x = loadOf(s.x, n, i), r = loadOf(s.r, n, i) - product(a, a.boxes[blocks[b].body], s.x, x, i);
      const Vec3 d = mulAdd(set(s.by), solved(a, r, i), set(s.again) * x);
      const Vec3 z = d + (s.fresh ? x : mulAdd(set(s.carried), x, loadOf(s.z, n, i)));
      storeTo(r, s.r, n, i);
      storeTo(d, s.d, n, i);
      storeTo(z, s.z, n, i);
      if (s.with) dots.add(dot(loadOf(s.with, n, i), z));
    }
    if (s.with) dots.close();
  }
}

void preconditionNodes(const multigrid::FineArrays& a, const float* r, float by, float* copy, float* d,
                       const multigrid::Block* blocks, size_t count) {
  for (size_t b = 0; b < count; ++b) {
    for (size_t i = blocks[b].at; i < blocks[b].at + multigrid::kBlock; i += hn::MaxLanes(Tag())) {
      const Vec3 lacks = loadOf(r, a.places, i);
      storeTo(lacks, copy, a.places, i);
      storeTo(set(by) * solved(a, lacks, i), d, a.places, i);
    }
  }
}

void advanceNodes(size_t places, float alpha, const float* p, const float* q, float* s, float* r,
                  const multigrid::Block* blocks, size_t count, double* sum) {
  BlockSum squares{hn::Zero(Tag()), sum};
  for (size_t b = 0; b < count; ++b) {
    for (size_t i = blocks[b].at; i < blocks[b].at + multigrid::kBlock; i += hn::MaxLanes(Tag())) {
      storeTo(mulAdd(set(alpha), loadOf(p, places, i), loadOf(s, places, i)), s, places, i);
      const Vec3 left = mulAdd(set(-alpha), loadOf(q, places, i), loadOf(r, places, i));
      storeTo(left, r, places, i);
      squares.add(dot(left, left));
    }
    squares.close();
  }
}

void turnNodes(size_t places, float beta, const float* z, float* p, const multigrid::Block* blocks, size_t count) {
  for (size_t b = 0; b < count; ++b) {
    for (size_t i = blocks[b].at; i < blocks[b].at + multigrid::kBlock; i += hn::MaxLanes(Tag())) {
      const Vec3 direction = loadOf(z, places, i);
      storeTo(beta == 0 ? direction : mulAdd(set(beta), loadOf(p, places, i), direction), p, places, i);
    }
  }
}

void dotNodes(size_t places, const float* a, const float* b, const multigrid::Block* blocks, size_t count,
              double* sum) {
  BlockSum dots{hn::Zero(Tag()), sum};
  for (size_t k = 0; k < count; ++k) {
    for (size_t i = blocks[k].at; i < blocks[k].at + multigrid::kBlock; i += hn::MaxLanes(Tag()))
      dots.add(dot(loadOf(a, places, i), loadOf(b, places, i)));
    dots.close();
  }
}

}  // namespace viscera::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viscera::simd {

HWY_EXPORT(lineariseCells);
HWY_EXPORT(lineariseNodes);
HWY_EXPORT(evaluateCells);
HWY_EXPORT(evaluateNodes);
HWY_EXPORT(applyCells);
HWY_EXPORT(applyNodes);
HWY_EXPORT(smoothNodes);
HWY_EXPORT(preconditionNodes);
HWY_EXPORT(advanceNodes);
HWY_EXPORT(turnNodes);
HWY_EXPORT(dotNodes);

}  // namespace viscera::simd

namespace viscera::multigrid {

FineKernels fineKernelsFor(const char* target) {
  const std::string wanted = target;
  int64_t chosen = 0;
  for (const int64_t each : hwy::SupportedAndGeneratedTargets()) {
    if (chosen == 0 || wanted == hwy::TargetName(each)) chosen = each;
    if (wanted.empty() || wanted == hwy::TargetName(each)) break;
  }
  using namespace simd;  // NOLINT: the tables of HWY_EXPORT
  return {VISCERA_KERNEL_FOR(lineariseCells, chosen), VISCERA_KERNEL_FOR(lineariseNodes, chosen),
          VISCERA_KERNEL_FOR(evaluateCells, chosen),  VISCERA_KERNEL_FOR(evaluateNodes, chosen),
          VISCERA_KERNEL_FOR(applyCells, chosen),     VISCERA_KERNEL_FOR(applyNodes, chosen),
          VISCERA_KERNEL_FOR(smoothNodes, chosen),    VISCERA_KERNEL_FOR(preconditionNodes, chosen),
          VISCERA_KERNEL_FOR(advanceNodes, chosen),   VISCERA_KERNEL_FOR(turnNodes, chosen),
          VISCERA_KERNEL_FOR(dotNodes, chosen)};
}

}  // namespace viscera::multigrid
#endif  // HWY_ONCE
