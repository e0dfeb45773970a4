// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/specimens/mode_frequency.h"

#include <gtest/gtest.h>

namespace viscera::bench {
namespace {

/// Returns the amplitudes of an oscillator that leapfrog integrates from rest at 1, every `stride` substeps.
std::vector<double> oscillation(double omega, double dt_s, int stride, int samples) {
  std::vector<double> out = {1};
  double u = 1, v = 0;
  for (int n = 1; n < samples * stride; ++n) {
    v -= (n == 1 ? 0.5 : 1.0) * dt_s * omega * omega * u;
    u += dt_s * v;
    if (n % stride == 0) out.push_back(u);
  }
  return out;
}

TEST(ModeFrequency, IsThatOfTheOscillatorWhateverTheSubstep) {
  for (double omega : {1.0, 3.0, 10.0}) {
    for (double dt_s : {0.01, 0.1, 0.19}) {
      const int stride = std::max(1, static_cast<int>(1.2 / phasePerSubstep(omega, dt_s)));
      // Only rounding errors of float64 remain, none of the time step: sin(omega dt/2) alone would be off by up to
      // 2e-2.
      EXPECT_NEAR(modeFrequency(oscillation(omega, dt_s, stride, 20), stride, dt_s) / omega, 1, 1e-12)
          << omega << ' ' << dt_s;
    }
  }
}

}  // namespace
}  // namespace viscera::bench
