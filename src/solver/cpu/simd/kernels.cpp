// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/simd/kernels.h"

#include "hwy/cache_control.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/cpu/simd/kernels.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "solver/cpu/simd/around-inl.h"
#include "solver/cpu/simd/cells-inl.h"
#include "solver/cpu/simd/springs-inl.h"
#include "solver/cpu/simd/targets.h"
#include "solver/cpu/simd/tiles-inl.h"

HWY_BEFORE_NAMESPACE();
namespace viscera::simd::HWY_NAMESPACE {

/// Sums the forces of springs on the nodes of a vector.
/// @param pull_of  returns SpringPull of the spring to (X, Y, Z) with index i
/// @param mild  set to whether all springs are mild (kMild)
template <class PullOf>
HWY_INLINE Vec3 sumOfSprings(const PullOf& pull_of, bool& mild) {
  Vec3 force = zero3();
  V largest = hn::Zero(Tag());
#define VISCERA_ADD(i, X, Y, Z)                                            \
  {                                                                        \
    const SpringPull s = pull_of.template operator()<X, Y, Z>(i, largest); \
    force = mulAdd(s.pull, s.e, force);                                    \
  }
  VISCERA_SPRINGS(VISCERA_ADD)
#undef VISCERA_ADD
  mild = hn::AllTrue(Tag(), hn::Lt(largest, set(kMild)));
  return force;
}

/// Springs that are mild, or springs of any length without dashpots.
template <bool kUniform, bool kAny>
struct PlainSprings {
  const Neighborhood& u;  ///< predicted if there are dashpots
  const Vec3 near;        ///< the same for the nodes themselves
  const Material& m;
  const float* k;  ///< stiffness of their first spring; the next is 16 farther

  template <int X, int Y, int Z>
  HWY_INLINE SpringPull operator()(int i, V& largest) const {
    const V stiffness = kUniform ? m.full[i < 6 ? 0 : 1] : load(k + i * 16);
    return springPull<X, Y, Z, kUniform, kAny, false>(m, stiffness, seen<X, Y, Z>(u) - near, zero3(), largest);
  }
};
/// Springs of any length with dashpots.
struct DampedSprings {
  const Neighborhood &u, &v, &predicted;
  const Vec3 near;  ///< predicted
  const Material& m;
  const float* k;

  template <int X, int Y, int Z>
  HWY_INLINE SpringPull operator()(int i, V& largest) const {
    const auto now = [&]() HWY_ATTR {
      return Apart{seen<X, Y, Z>(u) - seen<0, 0, 0>(u), seen<X, Y, Z>(v) - seen<0, 0, 0>(v)};
    };
    return predictedPull<X, Y, Z>(m, load(k + i * 16), seen<X, Y, Z>(predicted) - near, now, largest);
  }
};

/// The rarer cases, kept out of line.
HWY_NOINLINE Vec3 anySpringForce(const Neighborhood& u, const Material& m, const float* k, bool& mild) {
  return sumOfSprings(PlainSprings<false, true>{u, seen<0, 0, 0>(u), m, k}, mild);
}
HWY_NOINLINE Vec3 anySpringForce(const Neighborhood& u, const Neighborhood& v, const Neighborhood& predicted,
                                 const Material& m, const float* k, bool& mild) {
  return sumOfSprings(DampedSprings{u, v, predicted, seen<0, 0, 0>(predicted), m, k}, mild);
}

/// Displacements and velocities around a brick. With dashpots only few bricks need the current ones.
struct SpringViews {
  Around u, v, predicted;
  bool knows_u, knows_v;
};

/// Forces of springs on the nodes of a brick.
template <bool kUniform, bool kDashpot>
struct ForceOfSprings {
  const LeapfrogJob& job;
  const Material& material;
  SpringViews& views;
  uint32_t b;

  HWY_INLINE Neighborhood now(int i) const {
    const Arrays& a = job.arrays;
    if (!views.knows_u) lookAround(a, a.displacement, b, views.u);
    views.knows_u = true;
    return neighborhood(views.u, i);
  }
  HWY_INLINE Neighborhood speeds(int i) const {
    if (!views.knows_v) lookAround(job.arrays, job.arrays.velocity, b, views.v);
    views.knows_v = true;
    return neighborhood(views.v, i);
  }
  HWY_INLINE Vec3 anyForce(const Neighborhood& around, const float* k, int i, bool& mild) const {
    if (!kDashpot) return anySpringForce(around, material, k, mild);
    return anySpringForce(now(i), speeds(i), around, material, k, mild);
  }

  /// Returns the force on a vector of nodes.
  /// @param i  index of the vector's first node in the brick
  HWY_INLINE Vec3 operator()(int i) const {
    const Arrays& a = job.arrays;
    const Neighborhood around = neighborhood(kDashpot ? views.predicted : views.u, i);
    const float* k = a.spring_stiffness + springAt(size_t{b} * 64 + static_cast<size_t>(i), 0);
    // Vectors that were strained in the last substep are assumed to be strained still. The result depends on the state
    // alone, since the formula is chosen again if the assumption is wrong.
    const uint32_t bit = 1u << (i / 4);
    bool strained = (job.strained[b] & bit) != 0, mild;
    Vec3 force;
    if (HWY_UNLIKELY(strained)) {
      force = anyForce(around, k, i, mild);
      strained = !mild;
      if (mild) job.strained[b] = static_cast<uint16_t>(job.strained[b] & ~bit);
    }
    if (!strained) {
      force = sumOfSprings(PlainSprings<kUniform, false>{around, seen<0, 0, 0>(around), material, k}, mild);
      if (HWY_UNLIKELY(!mild)) {
        force = anyForce(around, k, i, mild);
        job.strained[b] = static_cast<uint16_t>(job.strained[b] | bit);
      }
    }
    return force;
  }
};

/// Forces of cells with a law on the nodes of a brick.
struct ForceOfCells {
  CellSources sources;
  HWY_INLINE Vec3 operator()(int i) const { return forceOfCells(sources, i); }
};

/// Steps one vector of nodes.
/// @param i  index of the vector's first node in the brick
/// @return |v|^2
HWY_INLINE V stepVector(const Arrays& a, const Motion& motion, uint32_t b, int i, const Vec3& force, Vec3& u_next) {
  const size_t slot = size_t{b} * 64 + static_cast<size_t>(i);
  const layout::NodeBits* const nodes = a.nodes ? a.nodes + slot : nullptr;
  const size_t to = size_t{b} * 192 + static_cast<size_t>(i);
  float* const lost = a.compensation ? a.compensation + size_t{b} * 384 + static_cast<size_t>(i) : nullptr;
  Vec3 v_next;
  move(motion, load(a.mobility + slot), nodes, force, loadPlanes(a.displacement + to), loadPlanes(a.velocity + to),
       lost, u_next, v_next);
  storePlanes(u_next, a.next_displacement + to);
  storePlanes(v_next, a.next_velocity + to);
  return dot(v_next, v_next);
}

/// Returns the vectors from the nearest points of a capsule's axis to points. @param off  from one of its ends
HWY_INLINE Vec3 fromAxis(const Reach& reach, const Vec3& off) {
  const Vec3 axis{set(reach.axis_m[0]), set(reach.axis_m[1]), set(reach.axis_m[2])};
  const V along = hn::Mul(dot(off, axis), set(reach.inverse_length2));
  const V share = hn::Min(hn::Max(along, hn::Zero(Tag())), set(1));
  return off - Vec3{hn::Mul(share, axis.x), hn::Mul(share, axis.y), hn::Mul(share, axis.z)};
}

/// Returns whether a node of the vector is within reach of a probe or a shaft.
HWY_INLINE bool inReach(const LeapfrogJob& job, const Vec3& x) {
  for (size_t r = 0; r < job.reaches; ++r) {
    const Reach& reach = job.reach[r];
    Vec3 off = x - Vec3{set(reach.center_m[0]), set(reach.center_m[1]), set(reach.center_m[2])};
    if (reach.inverse_length2 > 0) off = fromAxis(reach, off);
    // Slightly larger than needed, as the exact test rounds differently.
    if (!hn::AllFalse(Tag(), hn::Lt(dot(off, off), set(1.001f * reach.radius_m * reach.radius_m)))) return true;
  }
  return false;
}

/// Steps the nodes of a brick.
/// @param force_of  returns the force on a vector of nodes [N], by the index of its first
template <class ForceOf>
HWY_NOINLINE void stepBrick(const LeapfrogJob& job, const layout::BodyParams& body, uint32_t b,
                            const ForceOf& force_of) {
  const Arrays& a = job.arrays;
  const layout::Brick& brick = a.bricks[b];
  const Motion motion = motionOf(job.step, body);
  const float h = body.origin_spacing.w, edge = 4 * h;
  const float from[3] = {body.origin_spacing.x + edge * static_cast<float>(brick.coord_x),
                         body.origin_spacing.y + edge * static_cast<float>(brick.coord_y),
                         body.origin_spacing.z + edge * static_cast<float>(brick.coord_z)};
  V speed2 = hn::Zero(Tag());
  bool near = false;
  constexpr int kLanes = static_cast<int>(hn::MaxLanes(Tag()));
  for (int i = 0; i < 64; i += kLanes) {
    // Both states already have the positions of nodes that do not exist or never move.
    if (noRows(~uint32_t{a.idle_rows[b]}, i)) continue;
    Vec3 u_next;
    speed2 = hn::Max(speed2, stepVector(a, motion, b, i, force_of(i), u_next));
    if (job.reaches > 0 && !near) near = inReach(job, restOf(from, h, i) + u_next);
  }
  job.speed2[b] = hn::GetLane(hn::MaxOfLanes(Tag(), speed2));
  if (near) job.near[b] = 1;
}

/// Steps a brick with springs.
template <bool kDashpot>
HWY_INLINE void stepBySprings(const LeapfrogJob& job, const layout::BodyParams& body, uint32_t b, SpringViews& views) {
  const Material material = materialOf(body);
  if (kDashpot)
    lookAround(job.arrays, job.predicted, b, views.predicted);
  else
    lookAround(job.arrays, job.arrays.displacement, b, views.u);
  views.knows_u = !kDashpot;
  views.knows_v = false;
  if (job.arrays.uniform[b])
    stepBrick(job, body, b, ForceOfSprings<true, kDashpot>{job, material, views, b});
  else
    stepBrick(job, body, b, ForceOfSprings<false, kDashpot>{job, material, views, b});
}

/// The same, plus the forces of cells in thin walls.
struct ForceOfWalls {
  CellSources sources;
  const float* walls;
  HWY_INLINE Vec3 operator()(int i) const { return forceOfCells(sources, i) + loadPlanes(walls + i); }
};

void predictOf(const LeapfrogJob& job, const uint32_t* bricks, size_t count) {
  const Arrays& a = job.arrays;
  for (size_t n = 0; n < count; ++n) {
    const size_t from = size_t{bricks[n]} * 192;
    const V dashpot_s = set(a.bodies[a.bricks[bricks[n]].body].dashpot_s);
    for (size_t i = from; i < from + 192; i += hn::MaxLanes(Tag()))
      hn::StoreU(hn::MulAdd(dashpot_s, load(a.velocity + i), load(a.displacement + i)), Tag(), job.predicted + i);
  }
}

/// Prefetches the data of a brick's nodes. The pass over nodes with summed cells does little work per load.
HWY_INLINE void prefetchBrick(const Arrays& a, uint32_t b) {
  for (size_t i = 0; i < kCellSums; i += 16) hwy::Prefetch(a.cell_sums + size_t{b} * kCellSums + i);
  for (size_t i = 0; i < 192; i += 16) {
    hwy::Prefetch(a.displacement + size_t{b} * 192 + i);
    hwy::Prefetch(a.velocity + size_t{b} * 192 + i);
  }
}

void leapfrogOf(const LeapfrogJob& job, const uint32_t* bricks, size_t count) {
  SpringViews views;
  for (size_t n = 0; n < count; ++n) {
    const uint32_t b = bricks[n];
    const layout::BodyParams& body = job.arrays.bodies[job.arrays.bricks[b].body];
    if (body.law != layout::kLawSprings) {
      prefetchBrick(job.arrays, bricks[n + 1 < count ? n + 1 : n]);
      const float* walls = job.arrays.wall_forces;
      if (HWY_UNLIKELY(walls != nullptr) && job.arrays.in_wall[b])
        stepBrick(job, body, b, ForceOfWalls{sourcesOf(job.arrays, b), walls + size_t{b} * 192});
      else
        stepBrick(job, body, b, ForceOfCells{sourcesOf(job.arrays, b)});
    } else if (job.predicted) {
      stepBySprings<true>(job, body, b, views);
    } else {
      stepBySprings<false>(job, body, b, views);
    }
  }
}

}  // namespace viscera::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viscera::simd {

HWY_EXPORT(leapfrogOf);
HWY_EXPORT(predictOf);

BrickLeapfrog leapfrogFor(int64_t target) {
  return VISCERA_KERNEL_FOR(leapfrogOf, target);
}

BrickPredict predictFor(int64_t target) {
  return VISCERA_KERNEL_FOR(predictOf, target);
}

}  // namespace viscera::simd
#endif  // HWY_ONCE
