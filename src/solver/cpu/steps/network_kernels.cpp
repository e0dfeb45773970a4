// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/cpu/steps/network_kernels.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/cpu/steps/network_kernels.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"
#include "solver/cpu/simd/targets.h"
#include "solver/cpu/simd/vectors-inl.h"

HWY_BEFORE_NAMESPACE();
namespace viscera::simd::HWY_NAMESPACE {

constexpr float kCollapsedShare = 1e-6f;  // share of the rest length: kShortest of shaders/solver/tissue/spring.glsl
constexpr size_t kRun = 8;                // links that are summed before the sum is added to the others
constexpr float kLeast = 1e-30f;          // far below any length, to prevent division by 0

/// Returns every fourth of some vectors of four, next to each other.
/// @param at  of the first of them
template <class D>
HWY_INLINE hn::Vec<D> everyFourth(D d, const float* vectors, const int32_t* at) {
  if constexpr (hn::MaxLanes(d) == 4) {
    return hn::Load(d, vectors + *at);
  } else {
    const hn::Half<D> half;
    return hn::Combine(d, everyFourth(half, vectors, at + hn::MaxLanes(half)), everyFourth(half, vectors, at));
  }
}
/// Returns the vectors of a row's far ends. Loading whole vectors and transposing them takes a third of the time of
/// gathering three components.
HWY_INLINE Vec3 gathered(const float* vectors, const int32_t* at) {
  const Tag d;
  const hn::RepartitionToWide<Tag> pairs;  // pairs of components
  const V a = everyFourth(d, vectors, at), b = everyFourth(d, vectors, at + 1), c = everyFourth(d, vectors, at + 2),
          e = everyFourth(d, vectors, at + 3);
  const auto low = hn::BitCast(pairs, hn::InterleaveLower(d, a, b)),
             high = hn::BitCast(pairs, hn::InterleaveLower(d, c, e));
  const auto z_low = hn::BitCast(pairs, hn::InterleaveUpper(d, a, b)),
             z_high = hn::BitCast(pairs, hn::InterleaveUpper(d, c, e));
  return {hn::BitCast(d, hn::InterleaveLower(pairs, low, high)), hn::BitCast(d, hn::InterleaveUpper(pairs, low, high)),
          hn::BitCast(d, hn::InterleaveLower(pairs, z_low, z_high))};
}

/// A row's links, in the lanes of a vector.
struct Links {
  Vec3 d;  ///< rest offset
  V l0, prestrain, k;
  V per_length2;  ///< 1/l0^2
  M live;
};
/// Loads links of a row.
/// @param i  index of the row's first lane
HWY_INLINE Links linksOf(const LinkRows& rows, const LinkRows::Row& row, size_t i) {
  const float* const at = &rows.constants[row.constants];
  const uint32_t live = row.live >> i;
  const uint8_t bits[8] = {static_cast<uint8_t>(live), static_cast<uint8_t>(live >> 8)};
  const M mask = hn::LoadMaskBits(Tag(), bits);
  if (row.alike) return {{set(at[0]), set(at[1]), set(at[2])}, set(at[3]), set(at[4]), set(at[5]), set(at[6]), mask};
  const auto each = [&](size_t c) HWY_ATTR { return load(at + c * kGroupNodes + i); };
  const V l0 = each(3);
  return {{each(0), each(1), each(2)}, l0, each(4), each(5), hn::Div(set(1), hn::Mul(l0, l0)), mask};
}

/// Returns the force of links of any length (shaders/solver/tissue/spring.glsl, springBetween).
/// @param w  u_far - u_near
/// @param dv  v_far - v_near
/// @param twice  L^2 - l0^2
template <bool kDashpot>
HWY_INLINE Vec3 anyPull(const Links& of, const Vec3& w, const Vec3& dv, V twice, V dashpot_s) {
  const V least = set(kLeast);
  const Vec3 e = of.d + w;
  const V l = hn::Sqrt(dot(e, e));
  Vec3 direction = hn::Div(set(1), hn::Max(l, least)) * e;
  const M collapsed = hn::Le(l, hn::Max(hn::Mul(set(kCollapsedShare), of.l0), least));
  if (HWY_UNLIKELY(!hn::AllFalse(Tag(), collapsed))) {  // keeps its direction at rest
    const V per_length = hn::Div(set(1), hn::Sqrt(hn::Max(dot(of.d, of.d), least)));
    direction = select(collapsed, per_length * of.d, direction);
  }
  V pull = hn::Div(twice, hn::Max(hn::Add(l, of.l0), least));
  if (kDashpot) pull = hn::MulAdd(dashpot_s, dot(dv, direction), pull);
  return hn::Mul(of.k, pull) * direction;
}

/// Adds the forces of a row of links to its nodes.
/// @param far  of the row's first lane
template <bool kDashpot>
HWY_INLINE void addRow(const NetworkJob& job, const Links& of, const int32_t* far, const Vec3& u, const Vec3& v,
                       V dashpot_s, Vec3& force) {
  const Vec3 w = gathered(job.positions, far) - u;
  const Vec3 dv = kDashpot ? gathered(job.speeds, far) - v : v;
  const V twice = hn::Add(hn::MulAdd(set(2), dot(of.d, w), dot(w, w)), of.prestrain);
  const V q = hn::IfThenElseZero(of.live, hn::Mul(twice, of.per_length2));
  Vec3 added;
  if (HWY_LIKELY(hn::AllTrue(Tag(), hn::Lt(hn::Abs(q), set(kMild))))) {
    const Vec3 e = of.d + w;
    V c = hn::Mul(q, mildPhi(q));  // (L - l0) / L
    if (kDashpot) {
      const V ratio = hn::Sub(set(1), c);  // l0 / L
      c = hn::MulAdd(hn::Mul(dashpot_s, hn::Mul(of.per_length2, dot(dv, e))), hn::Mul(ratio, ratio), c);
    }
    added = hn::Mul(of.k, c) * e;
  } else {
    added = anyPull<kDashpot>(of, w, dv, twice, dashpot_s);
  }
  force = select(of.live, force + added, force);  // the ends of a cut spring may not even be finite
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
        Vec3 run = zero3();  // partial sums, as a single sum over hundreds of links would lose a digit
        for (const size_t end = std::min<size_t>(r + kRun, rows.starts[g + 1]); r < end; ++r) {
          addRow<kDashpot>(job, linksOf(rows, rows.rows[r], i), &rows.far[kGroupNodes * r + i], u, v, dashpot_s, run);
        }
        force = force + run;
      }
      float* const lost = job.compensation ? job.compensation + brick * 384 + inside : nullptr;
      Vec3 u_next, v_next;
      move(motion, load(job.mobility + slot + i), job.nodes ? job.nodes + slot + i : nullptr, force, u, v, lost, u_next,
           v_next);
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
      spread(job.displacement, job.positions, slot);
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
#include "solver/cpu/state/cpu_lattice.h"

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

constexpr size_t kConstants = 6;
constexpr double kAlikeCost = 0.6;  // cost of a row of equal links over another row, in a box of 42,875 nodes

std::array<float, kConstants> constantsOf(const layout::Link& link) {
  const layout::vec4& rest = link.offset_length;
  return {rest.x, rest.y, rest.z, rest.w, link.prestrain_m2, link.stiffness};
}

}  // namespace

LinkRows::LinkRows(const JoinedNetwork& network, const std::vector<uint32_t>& its_groups) : groups(its_groups) {
  starts.push_back(0);
  for (const uint32_t group : groups) {
    addGroup(network, group);
    starts.push_back(static_cast<uint32_t>(rows.size()));
  }
  far.resize(link.size());
  for (size_t g = 0; g < groups.size(); ++g) {
    for (size_t position = kGroupNodes * starts[g]; position < kGroupNodes * starts[g + 1]; ++position) {
      const auto slot = static_cast<uint32_t>(groups[g] * kGroupNodes + position % kGroupNodes);
      far[position] = static_cast<int32_t>(4 * (link[position] == kNone ? slot : network.links[link[position]].far));
    }
  }
  writeStiffness(network.links);
}

/// Adds the rows of 16 nodes: first links that many of them have in common, then the rest of each node. Both are in the
/// node's own order: sorted by direction, sums of hundreds of links would lose a digit.
void LinkRows::addGroup(const JoinedNetwork& network, uint32_t group) {
  std::map<std::array<float, kConstants>, size_t> known;
  std::vector<std::vector<uint32_t>> kinds;  // [16] equal links, by kind
  std::array<std::vector<uint32_t>, kGroupNodes> rest;
  const auto ofEach = [&](const auto& visit) {
    for (size_t i = 0; i < kGroupNodes; ++i) {
      const size_t slot = group * kGroupNodes + i;
      for (uint32_t l = network.starts[slot]; l < network.starts[slot + 1]; ++l) visit(i, l);
    }
  };
  ofEach([&](size_t i, uint32_t l) {
    const auto [kind, is_new] = known.emplace(constantsOf(network.links[l]), kinds.size());
    if (is_new) kinds.emplace_back(kGroupNodes, kNone);
    uint32_t& position = kinds[kind->second][i];
    if (position == kNone) position = l;
  });
  // Kinds that most nodes share come first. As many of them get rows of their own as minimize the total cost.
  std::vector<size_t> by_count(kinds.size());
  std::iota(by_count.begin(), by_count.end(), size_t{0});
  const auto shared = [&](size_t kind) {
    return std::count_if(kinds[kind].begin(), kinds[kind].end(), [](uint32_t l) { return l != kNone; });
  };
  std::stable_sort(by_count.begin(), by_count.end(), [&](size_t a, size_t b) { return shared(a) > shared(b); });
  std::array<size_t, kGroupNodes> left{};
  ofEach([&](size_t i, uint32_t) { ++left[i]; });
  std::vector<uint8_t> own(kinds.size());
  double least = static_cast<double>(*std::max_element(left.begin(), left.end()));
  for (size_t n = 0; n < by_count.size(); ++n) {
    for (size_t i = 0; i < kGroupNodes; ++i) left[i] -= kinds[by_count[n]][i] != kNone;
    const double cost =
        kAlikeCost * static_cast<double>(n + 1) + static_cast<double>(*std::max_element(left.begin(), left.end()));
    if (cost >= least) continue;
    least = cost;
    for (size_t m = 0; m <= n; ++m) own[by_count[m]] = 1;
  }
  ofEach([&](size_t i, uint32_t l) {
    const size_t kind = known.at(constantsOf(network.links[l]));
    if (!own[kind] || kinds[kind][i] != l) rest[i].push_back(l);
  });
  for (size_t kind = 0; kind < kinds.size(); ++kind) {
    if (own[kind]) addRow(network.links, kinds[kind]);
  }
  size_t width = 0;
  for (const std::vector<uint32_t>& each : rest) width = std::max(width, each.size());
  for (size_t r = 0; r < width; ++r) {
    std::vector<uint32_t> row(kGroupNodes, kNone);
    for (size_t i = 0; i < kGroupNodes; ++i) {
      if (r < rest[i].size()) row[i] = rest[i][r];
    }
    addRow(network.links, row);
  }
}

/// Adds one row.
/// @param its  [16] links
void LinkRows::addRow(const std::vector<layout::Link>& links, const std::vector<uint32_t>& its) {
  link.insert(link.end(), its.begin(), its.end());
  std::array<std::array<float, kConstants>, kGroupNodes> each;
  const std::array<float, kConstants>* first = nullptr;
  bool alike = true;
  for (size_t i = 0; i < kGroupNodes; ++i) {
    each[i] = its[i] == kNone ? std::array<float, kConstants>{1, 1, 1, 1} : constantsOf(links[its[i]]);
    if (its[i] == kNone) continue;
    if (!first) first = &each[i];
    alike = alike && each[i] == *first;
  }
  rows.push_back({static_cast<uint32_t>(constants.size()), 0, static_cast<uint16_t>(alike)});
  if (alike) {
    constants.insert(constants.end(), first->begin(), first->end());
    constants.push_back(1 / ((*first)[3] * (*first)[3]));
    constants.resize(constants.size() + kGroupNodes - kConstants -
                     1);  // whole vectors, so that loads stay within cache lines
    return;
  }
  for (size_t c = 0; c < kConstants; ++c) {
    for (size_t i = 0; i < kGroupNodes; ++i) constants.push_back(each[i][c]);
  }
}

void LinkRows::writeStiffness(const std::vector<layout::Link>& links) {
  for (size_t r = 0; r < rows.size(); ++r) {
    uint32_t live = 0;
    for (size_t i = 0; i < kGroupNodes; ++i) {
      const uint32_t its = link[kGroupNodes * r + i];
      if (its != kNone && links[its].stiffness > 0) live |= 1u << i;
    }
    rows[r].live = static_cast<uint16_t>(live);
  }
}

}  // namespace viscera::simd
#endif  // HWY_ONCE
