// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/network_kernels.h"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/cpu/network_kernels.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "solver/cpu/targets.h"
#include "solver/cpu/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace viscera::simd::HWY_NAMESPACE {

constexpr float kCollapsedShare = 1e-6f;  // of the rest length: kShortest of shaders/solver/spring.glsl
constexpr size_t kRun = 8;                // links that are summed before they are added to the others
constexpr float kLeast = 1e-30f;          // far below any length: nothing is divided by 0

/// Every fourth of some vectors of four, side by side. @param at  of the first of them
template <class D>
HWY_INLINE hn::Vec<D> everyFourth(D d, const float* vectors, const int32_t* at) {
  if constexpr (hn::MaxLanes(d) == 4) {
    return hn::Load(d, vectors + *at);
  } else {
    const hn::Half<D> half;
    return hn::Combine(d, everyFourth(half, vectors, at + hn::MaxLanes(half)), everyFourth(half, vectors, at));
  }
}
/// The vectors of a row's far ends: whole ones and transposed, which takes a third of the time that gathering three
/// components takes.
HWY_INLINE Vec3 gathered(const float* vectors, const int32_t* at) {
  const Tag d;
  const hn::RepartitionToWide<Tag> pairs;  // of components
  const V a = everyFourth(d, vectors, at), b = everyFourth(d, vectors, at + 1), c = everyFourth(d, vectors, at + 2),
          e = everyFourth(d, vectors, at + 3);
  const auto low = hn::BitCast(pairs, hn::InterleaveLower(d, a, b)),
             high = hn::BitCast(pairs, hn::InterleaveLower(d, c, e));
  const auto z_low = hn::BitCast(pairs, hn::InterleaveUpper(d, a, b)),
             z_high = hn::BitCast(pairs, hn::InterleaveUpper(d, c, e));
  return {hn::BitCast(d, hn::InterleaveLower(pairs, low, high)), hn::BitCast(d, hn::InterleaveUpper(pairs, low, high)),
          hn::BitCast(d, hn::InterleaveLower(pairs, z_low, z_high))};
}

/// What a row of links adds to the force on its nodes (shaders/solver/spring.glsl, springBetween).
/// @param constants, far  of the row's first lane
template <bool kDashpot>
HWY_INLINE void addRow(const NetworkJob& job, const float* constants, const int32_t* far, const Vec3& u, const Vec3& v,
                       V dashpot_s, Vec3& force) {
  const V k = load(constants + 5 * kGroupNodes);
  const Vec3 d = {load(constants), load(constants + kGroupNodes), load(constants + 2 * kGroupNodes)};
  const V l0 = load(constants + 3 * kGroupNodes), prestrain = load(constants + 4 * kGroupNodes);
  const Vec3 w = gathered(job.places, far) - u, e = d + w;
  const V l = hn::Sqrt(dot(e, e)), least = set(kLeast);
  Vec3 direction = hn::Div(set(1), hn::Max(l, least)) * e;
  const M collapsed = hn::Le(l, hn::Max(hn::Mul(set(kCollapsedShare), l0), least));
  if (HWY_UNLIKELY(!hn::AllFalse(Tag(), collapsed))) {  // keeps its direction at rest
    const V per_length = hn::Div(set(1), hn::Sqrt(hn::Max(dot(d, d), least)));
    direction = select(collapsed, per_length * d, direction);
  }
  const V twice = hn::Add(hn::MulAdd(set(2), dot(d, w), dot(w, w)), prestrain);
  V pull = hn::Div(twice, hn::Max(hn::Add(l, l0), least));
  if (kDashpot) pull = hn::MulAdd(dashpot_s, dot(gathered(job.speeds, far) - v, direction), pull);
  // A spring that is cut may join places that are not even finite.
  force = select(hn::Gt(k, hn::Zero(Tag())), mulAdd(hn::Mul(k, pull), direction, force), force);
}

template <bool kDashpot>
HWY_INLINE void stepGroups(const NetworkJob& job, size_t first, size_t last) {
  const LinkRows& rows = *job.rows;
  constexpr size_t kLanes = hn::MaxLanes(Tag());
  for (size_t g = first; g < last; ++g) {
    const size_t slot = size_t{rows.groups[g]} * kGroupNodes, brick = slot / layout::kBrickSlots;
    const layout::BodyParams& body = job.bodies[job.bricks[brick].body];
    const Motion motion = motionOf(job.step, body);
    const V dashpot_s = set(body.dashpot_s);
    for (size_t i = 0; i < kGroupNodes; i += kLanes) {
      const size_t inside = slot % layout::kBrickSlots + i, at = brick * 192 + inside;
      const Vec3 u = loadPlanes(job.displacement + at), v = loadPlanes(job.velocity + at);
      Vec3 force = zero3();
      for (size_t r = rows.starts[g]; r < rows.starts[g + 1];) {
        Vec3 run = zero3();  // short sums of their own: hundreds of links in one would lose a digit
        for (const size_t end = std::min<size_t>(r + kRun, rows.starts[g + 1]); r < end; ++r) {
          addRow<kDashpot>(job, &rows.constants[6 * kGroupNodes * r + i], &rows.far[kGroupNodes * r + i], u, v,
                           dashpot_s, run);
        }
        force = force + run;
      }
      float* const lost = job.compensation ? job.compensation + brick * 384 + inside : nullptr;
      Vec3 u_next, v_next;
      move(motion, load(job.mobility + slot + i), force, u, v, lost, u_next, v_next);
      storePlanes(u_next, job.next_displacement + at);
      storePlanes(v_next, job.next_velocity + at);
    }
  }
}

/// Writes `places` and `speeds`.
void spreadNetworkOf(const NetworkJob& job, size_t first, size_t last) {
  const auto spread = [&](const float* planes, float* vectors, size_t slot) HWY_ATTR {
    const Vec3 each = loadPlanes(planes + slot / layout::kBrickSlots * 192 + slot % layout::kBrickSlots);
    hn::StoreInterleaved4(each.x, each.y, each.z, hn::Zero(Tag()), Tag(), vectors + 4 * slot);
  };
  for (size_t g = first; g < last; ++g) {
    for (size_t i = 0; i < kGroupNodes; i += hn::MaxLanes(Tag())) {
      const size_t slot = size_t{job.rows->groups[g]} * kGroupNodes + i;
      spread(job.displacement, job.places, slot);
      if (job.dashpot) spread(job.velocity, job.speeds, slot);
    }
  }
}

void leapfrogNetworkOf(const NetworkJob& job, size_t first, size_t last) {
  if (job.dashpot) {
    stepGroups<true>(job, first, last);
  } else {
    stepGroups<false>(job, first, last);
  }
}

}  // namespace viscera::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "solver/cpu/cpu_lattice.h"

namespace viscera::simd {

HWY_EXPORT(leapfrogNetworkOf);
HWY_EXPORT(spreadNetworkOf);

NetworkGroups leapfrogNetworkFor(int64_t target) {
  return VISCERA_KERNEL_FOR(leapfrogNetworkOf, target);
}
NetworkGroups spreadNetworkFor(int64_t target) {
  return VISCERA_KERNEL_FOR(spreadNetworkOf, target);
}

namespace {

size_t valence(const JoinedNetwork& network, size_t slot) {
  return network.starts[slot + 1] - network.starts[slot];
}

size_t widthOf(const JoinedNetwork& network, uint32_t group) {
  size_t width = 0;
  for (size_t i = 0; i < kGroupNodes; ++i) width = std::max(width, valence(network, group * kGroupNodes + i));
  return width;
}

}  // namespace

LinkRows::LinkRows(const JoinedNetwork& network, const std::vector<uint32_t>& its_groups) : groups(its_groups) {
  starts.push_back(0);
  for (const uint32_t group : groups) starts.push_back(starts.back() + static_cast<uint32_t>(widthOf(network, group)));
  const size_t places = kGroupNodes * starts.back();
  link.assign(places, kNone);
  far.resize(places);
  constants.resize(6 * places);
  for (size_t g = 0; g < groups.size(); ++g) {
    for (size_t r = starts[g]; r < starts[g + 1]; ++r) {
      for (size_t i = 0; i < kGroupNodes; ++i) {
        const auto slot = static_cast<uint32_t>(groups[g] * kGroupNodes + i);
        const size_t place = kGroupNodes * r + i;
        far[place] = static_cast<int32_t>(4 * slot);
        float* const lane = &constants[6 * kGroupNodes * r + i];
        lane[0] = lane[3 * kGroupNodes] = 1;  // any length but 0
        if (r - starts[g] >= valence(network, slot)) continue;
        link[place] = network.starts[slot] + static_cast<uint32_t>(r - starts[g]);
        const layout::Link& its = network.links[link[place]];
        far[place] = static_cast<int32_t>(4 * its.far);
        const float values[5] = {its.offset_length.x, its.offset_length.y, its.offset_length.z, its.offset_length.w,
                                 its.prestrain_m2};
        for (size_t c = 0; c < 5; ++c) lane[c * kGroupNodes] = values[c];
      }
    }
  }
  writeStiffness(network.links);
}

void LinkRows::writeStiffness(const std::vector<layout::Link>& links) {
  for (size_t place = 0; place < link.size(); ++place) {
    const size_t at = 6 * kGroupNodes * (place / kGroupNodes) + 5 * kGroupNodes + place % kGroupNodes;
    constants[at] = link[place] == kNone ? 0 : links[link[place]].stiffness;
  }
}

}  // namespace viscera::simd
#endif  // HWY_ONCE
