// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/kernels.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/cpu/kernels.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "solver/cpu/targets.h"
#include "solver/cpu/tiles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace viscera::simd::HWY_NAMESPACE {

// With q = (L^2 - l0^2) / l0^2, computed without cancellation, the force of a spring on its near end is
//   k (L - l0)/L e = k q phi(q) e,  phi(q) = 1 / (1 + q + sqrt(1 + q)),  e = vector to the far end (physics.md 1, 2).
// Below kShortest of its length at rest a spring has no direction of its own (shaders/solver/spring.glsl).
constexpr float kShortest2 = 1e-12f;

/// phi for any q > -1: one Newton step each on the processor's estimates of 1/sqrt(4 x) and of 1/(4 x + 4 sqrt(x)),
/// x = 1 + q, where they have 12 bits at least; else exact.
HWY_INLINE V anyPhi(V q) {
  const V x4 = hn::Max(hn::MulAdd(q, set(4), set(4)), set(1e-24f));
#if HWY_ARCH_X86
  const V estimate = hn::ApproximateReciprocalSqrt(x4);
  const V t = hn::Mul(x4, estimate);
  const V d4 = hn::MulAdd(t, hn::NegMulAdd(t, estimate, set(3)), x4);
  const V r = hn::ApproximateReciprocal(d4);
  return hn::Mul(hn::Mul(set(4), r), hn::NegMulAdd(d4, r, set(2)));
#else
  return hn::Div(set(4), hn::MulAdd(set(2), hn::Sqrt(x4), x4));
#endif
}

/// What a spring adds to the force on its near end.
/// @param w  u_far - u_near   @param dv  v_far - v_near   @param largest  |q| so far
template <int X, int Y, int Z, bool kUniform, bool kAny, bool kDashpot>
HWY_INLINE void addSpring(const Material& m, V k, const Vec3& w, const Vec3& dv, V& largest, Vec3& force) {
  constexpr int kKind = X * X + Y * Y + Z * Z - 1;
  V q = hn::Mul(dot(w, shifted<X, Y, Z>(w, m.h2)), m.per_length2[kKind]);
  // Springs that are not there have no say in whether the others are mild, and no power of q that is infinite.
  if (!kUniform) q = hn::IfThenElseZero(hn::Gt(k, hn::Zero(Tag())), q);
  largest = hn::Max(largest, hn::Abs(q));
  Vec3 e = shifted<X, Y, Z>(w, m.h);
  V phi;
  if (kAny) {
    phi = anyPhi(q);
    const V x = hn::Add(set(1), q);
    const M collapsed = hn::Lt(x, set(kShortest2));
    if (HWY_UNLIKELY(!hn::AllFalse(Tag(), collapsed))) {  // k ext in the direction at rest
      // So that q phi is ext / l0 and e, of length l0, stands for the direction.
      phi = hn::IfThenElse(collapsed, set(1), phi);
      e = select(collapsed, shifted<X, Y, Z>(zero3(), m.h), e);
    }
  } else {
    phi = mildPhi(q);
  }
  V c = hn::Mul(q, phi);
  if (kDashpot) {
    V ratio = hn::NegMulAdd(q, phi, set(1));  // l0 / L; 1 where e is the direction at rest
    if (kAny) ratio = hn::IfThenElse(hn::Lt(hn::Add(set(1), q), set(kShortest2)), set(1), ratio);
    c = hn::MulAdd(hn::Mul(dot(dv, e), m.dashpot_length2[kKind]), hn::Mul(ratio, ratio), c);
  }
  force = mulAdd(hn::Mul(k, c), e, force);
}

/// Springs' force on the nodes of a vector.
/// @param k  stiffness of their first spring; the next is 64 farther   @param mild  all springs are, see kMild
template <bool kUniform, bool kAny, bool kDashpot>
HWY_INLINE Vec3 springForce(const Tile& u, const Tile& v, int at, const Material& m, const float* k, bool& mild) {
  const Vec3 near = seen<0, 0, 0>(u, at);
  const Vec3 near_v = kDashpot ? seen<0, 0, 0>(v, at) : zero3();
  Vec3 force = zero3();
  V largest = hn::Zero(Tag());
#define VISCERA_ADD(i, X, Y, Z)                                                                          \
  addSpring<X, Y, Z, kUniform, kAny, kDashpot>(m, kUniform ? m.full[(i) < 6 ? 0 : 1] : load(k + (i)*64), \
                                               seen<X, Y, Z>(u, at) - near,                              \
                                               kDashpot ? seen<X, Y, Z>(v, at) - near_v : near_v, largest, force);
  VISCERA_SPRINGS(VISCERA_ADD)
#undef VISCERA_ADD
  mild = hn::AllTrue(Tag(), hn::Lt(largest, set(kMild)));
  return force;
}

/// The rarer case, kept out of the way of the other.
template <bool kDashpot>
HWY_NOINLINE Vec3 anySpringForce(const Tile& u, const Tile& v, int at, const Material& m, const float* k, bool& mild) {
  return springForce<false, true, kDashpot>(u, v, at, m, k, mild);
}

/// What the volume of one of the eight cells around adds to the force on its corner (A, B, C).
template <int A, int B, int C>
HWY_INLINE void addVolume(const Tile& u, int at, V quarter, V bulk, Vec3& force) {
  if (hn::AllTrue(Tag(), hn::Eq(bulk, hn::Zero(Tag())))) return;
  Vec3 n[8];
  cornersAround<A, B, C>(u, at, n);
  const Shape s = shapeOf(n, quarter);
  const V p = hn::Mul(pressureOf(bulk, s.e), quarter), minus = hn::Neg(p);
  force = mulAdd(A ? minus : p, s.bc, force);
  force = mulAdd(B ? minus : p, s.ca, force);
  force = mulAdd(C ? minus : p, s.ab, force);
}

/// Volumes' force on the nodes of a vector. @param bulk  of their first cell around; the next is 64 farther
HWY_NOINLINE void addVolumes(const Tile& u, int at, V quarter, const float* bulk, Vec3& force) {
  addVolume<0, 0, 0>(u, at, quarter, load(bulk), force);
  addVolume<1, 0, 0>(u, at, quarter, load(bulk + 64), force);
  addVolume<0, 1, 0>(u, at, quarter, load(bulk + 128), force);
  addVolume<1, 1, 0>(u, at, quarter, load(bulk + 192), force);
  addVolume<0, 0, 1>(u, at, quarter, load(bulk + 256), force);
  addVolume<1, 0, 1>(u, at, quarter, load(bulk + 320), force);
  addVolume<0, 1, 1>(u, at, quarter, load(bulk + 384), force);
  addVolume<1, 1, 1>(u, at, quarter, load(bulk + 448), force);
}

/// Where the sums of the cells around a brick's nodes are (cell_kernels.cpp): of the brick and of those below it along
/// x, y and z, bit per axis. Below along x it is what left their rows, along y the fifth rows, along z the fifth
/// planes.
struct CellSources {
  const float* of[8];
};
HWY_INLINE CellSources sourcesOf(const Arrays& a, uint32_t b) {
  alignas(64) static constexpr float kNothing[kCellSums] = {};
  CellSources out;
  for (int below = 0; below < 8; ++below) {
    const int direction = 13 - (below & 1) - 3 * (below >> 1 & 1) - 9 * (below >> 2);
    const uint32_t brick = a.bricks[b].neighbors[direction];
    const float* sums = brick == b && below != 0 ? kNothing : a.cell_sums + size_t{brick} * kCellSums;
    out.of[below] = sums + sumsAt(below & 1 ? kRightSums : kOwnSums, 0, 0);
  }
  return out;
}

/// Adds force of the cells around to the nodes of a vector. @param i  index of the first in the brick
HWY_INLINE void addCells(const CellSources& sources, int i, Vec3& force) {
  for (int below = 0; below < ((i >> 4) == 0 ? 8 : 4); ++below) {
    const int plane = below & 4 ? 4 : i >> 4, row = below & 2 ? kFifthRow : 0;
    const float* at = sources.of[below] + sumsAt(0, plane, 0) + row + (i & 15);
    force = force + Vec3{load(at), load(at + kSumRows), load(at + 2 * kSumRows)};
  }
}

/// Rest position of a vector's nodes [m]. @param from  rest position of the brick's first slot   @param i  index of the
/// first node
HWY_INLINE Vec3 restOf(const float (&from)[3], float h, int i) {
  alignas(64) static constexpr float kX[16] = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
  alignas(64) static constexpr float kY[16] = {0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};
  const V spacing = set(h);
  return {hn::MulAdd(spacing, load(kX), set(from[0])), hn::MulAdd(spacing, load(kY + (i & 15)), set(from[1])),
          set(from[2] + h * static_cast<float>(i >> 4))};
}

struct Stepping {
  Material material;
  Motion motion;
  CellSources cells;  ///< where there are sums of cells
};

/// One vector of nodes. @param i  index of the first in the brick   @return |v|^2
template <bool kUniform, bool kDashpot>
HWY_INLINE V stepVector(const LeapfrogJob& job, const Stepping& s, const Tile& u, const Tile& v, uint32_t b, int i,
                        V mobility, Vec3& u_next) {
  const Arrays& a = job.arrays;
  const int at = ((i >> 4) + 1) * kPlane + kOwn + (i & 15);
  const float* k = a.spring_stiffness + size_t{b} * 1152 + i;
  // What was strained in the last substep is taken to be so still; which formula counts is the state's affair alone.
  const uint32_t bit = 1u << (i / 4);
  bool strained = (job.strained[b] & bit) != 0, mild;
  Vec3 force;
  if (HWY_UNLIKELY(strained)) {
    force = anySpringForce<kDashpot>(u, v, at, s.material, k, mild);
    strained = !mild;
    if (mild) job.strained[b] = static_cast<uint16_t>(job.strained[b] & ~bit);
  }
  if (!strained) {
    force = springForce<kUniform, false, kDashpot>(u, v, at, s.material, k, mild);
    if (HWY_UNLIKELY(!mild)) {
      force = anySpringForce<kDashpot>(u, v, at, s.material, k, mild);
      job.strained[b] = static_cast<uint16_t>(job.strained[b] | bit);
    }
  }
  if (a.cell_sums) {
    addCells(s.cells, i, force);
  } else if (a.bulk_around) {
    const V quarter = hn::Div(set(0.25f), s.material.h);
    addVolumes(u, at, quarter, a.bulk_around + size_t{b} * 512 + i, force);
  }
  const size_t to = size_t{b} * 192 + static_cast<size_t>(i);
  float* const lost = a.compensation ? a.compensation + size_t{b} * 384 + static_cast<size_t>(i) : nullptr;
  Vec3 v_next;
  move(s.motion, mobility, force, seen<0, 0, 0>(u, at), loadPlanes(a.velocity + to), lost, u_next, v_next);
  storePlanes(u_next, a.next_displacement + to);
  storePlanes(v_next, a.next_velocity + to);
  return dot(v_next, v_next);
}

/// Is a node of the vector within reach of a probe?
HWY_INLINE bool inReach(const LeapfrogJob& job, const Vec3& x) {
  for (size_t r = 0; r < job.reaches; ++r) {
    const Reach& reach = job.reach[r];
    const Vec3 off = x - Vec3{set(reach.center_m[0]), set(reach.center_m[1]), set(reach.center_m[2])};
    // A little more than is needed: who looks closer rounds otherwise.
    if (!hn::AllFalse(Tag(), hn::Lt(dot(off, off), set(1.001f * reach.radius_m * reach.radius_m)))) return true;
  }
  return false;
}

template <bool kUniform, bool kDashpot>
HWY_NOINLINE void stepBrick(const LeapfrogJob& job, const Stepping& s, const layout::BodyParams& body, const Tile& u,
                            const Tile& v, uint32_t b) {
  const Arrays& a = job.arrays;
  const layout::Brick& brick = a.bricks[b];
  const float h = body.origin_spacing.w, edge = 4 * h;
  const float from[3] = {body.origin_spacing.x + edge * static_cast<float>(brick.coord_x),
                         body.origin_spacing.y + edge * static_cast<float>(brick.coord_y),
                         body.origin_spacing.z + edge * static_cast<float>(brick.coord_z)};
  V speed2 = hn::Zero(Tag());
  bool near = false;
  constexpr int kLanes = static_cast<int>(hn::MaxLanes(Tag()));
  for (int i = 0; i < 64; i += kLanes) {
    // Nodes that are not there or never move: both states have their places already.
    constexpr uint32_t kRows = (1u << (hn::MaxLanes(Tag()) / 4)) - 1;
    if (((~uint32_t{a.idle_rows[b]} >> (i / 4)) & kRows) == 0) continue;
    const V mobility = load(a.mobility + size_t{b} * 64 + static_cast<size_t>(i));
    Vec3 u_next;
    speed2 = hn::Max(speed2, stepVector<kUniform, kDashpot>(job, s, u, v, b, i, mobility, u_next));
    if (job.reaches > 0 && !near) near = inReach(job, restOf(from, h, i) + u_next);
  }
  job.speed2[b] = hn::GetLane(hn::MaxOfLanes(Tag(), speed2));
  if (near) job.near[b] = 1;
}

template <bool kDashpot>
void stepBricks(const LeapfrogJob& job, const uint32_t* bricks, size_t count) {
  Tile u, v;
  for (size_t n = 0; n < count; ++n) {
    const uint32_t b = bricks[n];
    const layout::BodyParams& body = job.arrays.bodies[job.arrays.bricks[b].body];
    Stepping s = {materialOf(body), motionOf(job.step, body), {}};
    if (job.arrays.cell_sums) s.cells = sourcesOf(job.arrays, b);
    if (job.arrays.bulk_around && !job.arrays.cell_sums)
      fill<true>(job.arrays, job.arrays.displacement, b, u);
    else
      fill<false>(job.arrays, job.arrays.displacement, b, u);
    if (kDashpot) fill<false>(job.arrays, job.arrays.velocity, b, v);
    if (job.arrays.uniform[b])
      stepBrick<true, kDashpot>(job, s, body, u, v, b);
    else
      stepBrick<false, kDashpot>(job, s, body, u, v, b);
  }
}

void leapfrogOf(const LeapfrogJob& job, const uint32_t* bricks, size_t count) {
  if (job.dashpot)
    stepBricks<true>(job, bricks, count);
  else
    stepBricks<false>(job, bricks, count);
}

}  // namespace viscera::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viscera::simd {

HWY_EXPORT(leapfrogOf);

BrickLeapfrog leapfrogFor(int64_t target) {
  return VISCERA_KERNEL_FOR(leapfrogOf, target);
}

}  // namespace viscera::simd
#endif  // HWY_ONCE
