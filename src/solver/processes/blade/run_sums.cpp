// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "solver/processes/blade/run_sums.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "solver/processes/blade/run_sums.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace viscera::blade_runs::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using RunTag = hn::CappedTag<float, 8>;
using RunVector = hn::Vec<RunTag>;

/// Without fused multiply-add: processors without it round differently.
HWY_INLINE RunVector plusTimes(RunVector sum, RunVector a, RunVector b) {
  return hn::Add(sum, hn::Mul(a, b));
}

void sum(const WeightedRuns& runs, const float* const* planes, float* out) {
  const size_t lanes = hn::Lanes(RunTag());
  float sums[6][8];
  for (size_t lane = 0; lane < 8; lane += lanes) {
    RunVector s0 = hn::Zero(RunTag()), s1 = s0, s2 = s0, s3 = s0, s4 = s0, s5 = s0;
    for (size_t i = 0; i < runs.count; ++i) {
      const RunVector weight = hn::LoadU(RunTag(), runs.weights + 8 * i + lane);
      const size_t n = 8 * size_t{runs.runs[i]} + lane;
      s0 = plusTimes(s0, weight, hn::LoadU(RunTag(), planes[0] + n));
      s1 = plusTimes(s1, weight, hn::LoadU(RunTag(), planes[1] + n));
      s2 = plusTimes(s2, weight, hn::LoadU(RunTag(), planes[2] + n));
      s3 = plusTimes(s3, weight, hn::LoadU(RunTag(), planes[3] + n));
      s4 = plusTimes(s4, weight, hn::LoadU(RunTag(), planes[4] + n));
      s5 = plusTimes(s5, weight, hn::LoadU(RunTag(), planes[5] + n));
    }
    hn::StoreU(s0, RunTag(), sums[0] + lane);
    hn::StoreU(s1, RunTag(), sums[1] + lane);
    hn::StoreU(s2, RunTag(), sums[2] + lane);
    hn::StoreU(s3, RunTag(), sums[3] + lane);
    hn::StoreU(s4, RunTag(), sums[4] + lane);
    hn::StoreU(s5, RunTag(), sums[5] + lane);
  }
  for (int k = 0; k < 6; ++k) {
    const float* const s = sums[k];
    out[k] = ((s[0] + s[4]) + (s[1] + s[5])) + ((s[2] + s[6]) + (s[3] + s[7]));
  }
}

void add(const WeightedRuns& runs, const float* parts, float* const* planes) {
  const size_t lanes = hn::Lanes(RunTag());
  for (size_t i = 0; i < runs.count; ++i) {
    for (size_t lane = 0; lane < 8; lane += lanes) {
      const RunVector weight = hn::LoadU(RunTag(), runs.weights + 8 * i + lane);
      for (int a = 0; a < 3; ++a) {
        float* const at = planes[a] + 8 * size_t{runs.runs[i]} + lane;
        hn::StoreU(plusTimes(hn::LoadU(RunTag(), at), hn::Set(RunTag(), parts[a]), weight), RunTag(), at);
      }
    }
  }
}

void push(const PushedRuns& runs) {
  const size_t lanes = hn::Lanes(RunTag());
  const RunVector zero = hn::Zero(RunTag()), dt_s = hn::Set(RunTag(), runs.dt_s);
  for (size_t i = 0; i < runs.count; ++i) {
    const size_t slot = runs.slots[i], first = slot / 64 * 192 + slot % 64;
    bool rests = true;
    for (size_t lane = 0; lane < 8; lane += lanes) {
      const auto fixed = hn::Eq(hn::LoadU(RunTag(), runs.mobility + slot + lane), zero);
      const RunVector mass = hn::LoadU(RunTag(), runs.mass_kg + slot + lane);
      for (size_t a = 0; a < 3; ++a) {
        const size_t at = first + 64 * a + lane;
        const RunVector dv = hn::IfThenZeroElse(fixed, hn::LoadU(RunTag(), runs.dv_m_per_s[a] + 8 * i + lane));
        rests = rests && hn::AllTrue(RunTag(), hn::Eq(dv, zero));
        hn::StoreU(hn::Add(hn::LoadU(RunTag(), runs.v + at), dv), RunTag(), runs.v + at);
        hn::StoreU(plusTimes(hn::LoadU(RunTag(), runs.u + at), dt_s, dv), RunTag(), runs.u + at);
        hn::StoreU(plusTimes(hn::LoadU(RunTag(), runs.pushed + at), mass, dv), RunTag(), runs.pushed + at);
      }
    }
    if (!rests) runs.bricks[slot / 64] = 1;
  }
}

}  // namespace viscera::blade_runs::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viscera {

namespace blade_runs {
HWY_EXPORT(sum);
HWY_EXPORT(add);
HWY_EXPORT(push);
}  // namespace blade_runs

void sumRuns(const WeightedRuns& runs, const float* const (&planes)[6], float (&out)[6]) {
  using namespace blade_runs;
  HWY_DYNAMIC_DISPATCH(sum)(runs, planes, out);
}

void addToRuns(const WeightedRuns& runs, const float (&parts)[3], float* const (&planes)[3]) {
  using namespace blade_runs;
  HWY_DYNAMIC_DISPATCH(add)(runs, parts, planes);
}

void pushRuns(const PushedRuns& runs) {
  using namespace blade_runs;
  HWY_DYNAMIC_DISPATCH(push)(runs);
}

}  // namespace viscera
#endif  // HWY_ONCE
