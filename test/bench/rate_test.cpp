// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "bench/harness/rate.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "bench/harness/machine/machine.h"

namespace viscera::bench {
namespace {

TEST(Rate, MedianAndPercentileAreValuesOfTheList) {
  EXPECT_EQ(median({3, 1, 2}), 2);
  EXPECT_EQ(median({7}), 7);
  std::vector<double> hundred;
  for (int i = 100; i > 0; --i) hundred.push_back(i);
  EXPECT_EQ(percentile(hundred, 0.99), 100);
  EXPECT_EQ(percentile(hundred, 0), 1);
}

TEST(Rate, IsTheMedianOfRoundsTakenInTurn) {
  std::string turns;
  const auto sleeper = [&turns](char name, int ms) {
    return Candidate{std::string(1, name), 1000, [&turns, name, ms] {
                       turns += name;
                       std::this_thread::sleep_for(std::chrono::milliseconds(ms));
                       return 10.0;
                     }};
  };
  const std::vector<Rate> rates = measureRates({sleeper('a', 2), sleeper('b', 8)}, 1e-3, 3);
  EXPECT_EQ(turns, "aabbababab");  // two warm-up ticks each, then one tick each per round
  // A sleep takes at least the requested time, and longer on a busy machine.
  EXPECT_LE(rates[0].substeps_per_s, 10 / 2e-3);
  EXPECT_GT(rates[0].substeps_per_s, rates[1].substeps_per_s);
  EXPECT_DOUBLE_EQ(rates[1].node_updates_per_s, 1000 * rates[1].substeps_per_s);
}

TEST(Machine, HasRatesThatAreNumbers) {
  EXPECT_GT(fmaRate(1, 0.01), 1e8);
  EXPECT_GT(copyRate(2, 4), 1e7);
  EXPECT_GT(residentBytes(), 1e6);
  EXPECT_FALSE(fmaTarget().empty());
}

}  // namespace
}  // namespace viscera::bench
