// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <chrono>
#include <cstdint>

#include "bench/harness/machine/machine.h"
#include "bench/harness/machine/machine_threads.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/harness/machine/machine_fma.cpp"
#include "hwy/foreach_target.h"  // IWYU pragma: keep
// <hwy/foreach_target.h> must come first
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace viscera::bench::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Number of concurrent chains of multiply-adds: enough for two units with a latency of five, and they fit into
/// registers.
constexpr int kChains = 12;

/// Computes chains of multiply-adds.
/// @return number of operations   @param sink  receives a result, so that the work is not optimised away
double multiplyAdds(int64_t rounds, float* sink) {
  const hn::ScalableTag<float> d;
  const auto factor = hn::Set(d, 0.999f), term = hn::Set(d, 1e-3f * sink[0]);
  hn::Vec<decltype(d)> sums[kChains];
  for (int c = 0; c < kChains; ++c) sums[c] = hn::Set(d, static_cast<float>(c));
  for (int64_t r = 0; r < rounds; ++r) {
    for (int c = 0; c < kChains; ++c) sums[c] = hn::MulAdd(sums[c], factor, term);
  }
  for (int c = 1; c < kChains; ++c) sums[0] = hn::Add(sums[0], sums[c]);
  sink[0] = hn::GetLane(sums[0]);
  return 2.0 * kChains * static_cast<double>(hn::Lanes(d)) * static_cast<double>(rounds);
}

}  // namespace viscera::bench::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace viscera::bench {

HWY_EXPORT(multiplyAdds);

namespace {

constexpr int64_t kRounds = 100000;  // about 0.1 ms
constexpr int kParts = 10;           // number of parts of the measurement: the best one counts

double fmaAlone(double seconds) {
  using Clock = std::chrono::steady_clock;
  float sink = 1;
  double best = 0;
  for (int part = 0; part < kParts; ++part) {
    const auto start = Clock::now();
    double done = 0, took_s = 0;
    while (took_s < seconds / kParts) {
      done += HWY_DYNAMIC_DISPATCH(multiplyAdds)(kRounds, &sink);
      took_s = std::chrono::duration<double>(Clock::now() - start).count();
    }
    best = std::max(best, done / took_s);
  }
  return sink == 0 ? 0 : best;
}

}  // namespace

double fmaRate(int threads, double seconds) {
  return sumOverThreads(threads, [seconds] { return fmaAlone(seconds); });
}

std::string fmaTarget() {
  return hwy::TargetName(hwy::SupportedAndGeneratedTargets()[0]);
}

}  // namespace viscera::bench
#endif  // HWY_ONCE
