// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <array>
#include <fstream>
#include <iostream>
#include <map>
#include <set>
#include <string>

#include "bench/harness/rate.h"
#include "bench/harness/specimens/scalar_lattice.h"
#include "bench/suites/speed/speed_parts.h"
#include "solver/cpu/cpu_solver.h"

// Ratios of speed within one run, from the fastest rounds of each on one thread in turn. Noise of the machine hardly
// affects them, so that a lost factor of two shows. HotLoop in test/solver checks that a tick allocates nothing.

namespace viscera::bench {
namespace {

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // code slows down unevenly there

// Least share of the measured ratios (docs/benchmarks.md). On the processor of the measurements rounds differ by a
// tenth, and only half of the ratio fails. Other processors have other vector widths and caches: there a lost factor of
// three shows.
constexpr double kHeldThere = 2.0 / 3, kHeldElsewhere = 1.0 / 3;
const std::set<std::string> kMeasuredOn = {"vendor_id\t: AuthenticAMD", "cpu family\t: 26"};
constexpr double kRound_s = 0.001;  // a tick or two: shorter than the time slice that a busy machine gives a thread
constexpr int kRounds = 31;
constexpr int kAttempts = 4;  // another program may run throughout one attempt
constexpr int kEdge = 20;     // nodes along an edge; 8,000 in total
constexpr double kSettle_s = 1.5;

double held() {
  std::ifstream file("/proc/cpuinfo");
  size_t found = 0;
  for (std::string line; std::getline(file, line) && !line.empty();) found += kMeasuredOn.count(line);  // first CPU
  return found == kMeasuredOn.size() ? kHeldThere : kHeldElsewhere;
}

/// Returns the time of a node's substep in `slow` over that in `fast`.
double timesAsLong(const Candidate& slow, const Candidate& fast) {
  const std::vector<Rate> rates = measureRates({slow, fast}, kRound_s, kRounds);
  return rates[0].fastest_s / slow.nodes / (rates[1].fastest_s / fast.nodes);
}

/// Expects timesAsLong() to be at least held() of its nominal value and, with `at_most`, at most the inverse of held()
/// times it.
void hold(const std::string& what, double nominal, const Candidate& slow, const Candidate& fast, bool at_most = false) {
  const double share = held();
  std::vector<double> seen;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    seen.push_back(timesAsLong(slow, fast));
    if (seen.back() >= share * nominal && (!at_most || seen.back() <= nominal / share)) {
      std::cout << what << ": " << seen.back() << ", nominal " << nominal << std::endl;
      return;
    }
  }
  ADD_FAILURE() << what << ": " << ::testing::PrintToString(seen) << ", nominal " << nominal;
}

Candidate onOneThread(const Specimen& specimen, const ToolMotions& motions = {}) {
  return candidate("", onCpu(specimen, 1), specimen.nodes(), motions);
}

Candidate scalarLoop(const Specimen& specimen) {
  const double dt_s = 1 / (specimen.scene.solver.tick_hz * kSpecimenSubsteps);
  auto lattice = std::make_shared<ScalarLattice>(specimen.model, specimen.start, dt_s);
  return {"", static_cast<double>(specimen.nodes()), [lattice] {
            lattice->substep();
            return 1.0;
          }};
}

TEST(Guard, SimdIsAsMuchFasterThanTheScalarLoopAsItWas) {
  // Nominal ratios by instruction set, without and with a dashpot.
  const std::map<std::string, std::array<double, 2>> nominal = {
      {"AVX3", {15.5, 17}}, {"AVX2", {7.9, 9.5}}, {"SSE4", {3.4, 4.2}}};
  const Specimen plain = cubeOf(kEdge), damped = cubeOf(kEdge, specimenMaterial(0.2));
  for (const std::string& simd : simdTargets()) {
    const auto at = nominal.find(simd);
    if (at == nominal.end()) continue;
    for (const Specimen* cube : {&plain, &damped})
      hold(simd + " over the scalar loop" + (cube == &damped ? ", dashpot" : ""), at->second[cube == &damped ? 1 : 0],
           scalarLoop(*cube), candidate("", onCpu(*cube, 1, simd), cube->nodes()));
  }
}

TEST(Guard, ANodeOfAHeartCostsNoMoreOfACubesThanItDid) {
  const Specimen cube = cubeOf(kEdge), heart = heartOf(10000);
  hold("a cube's node over a heart's", 0.45, onOneThread(cube), onOneThread(heart));
}

TEST(Guard, TissueAsleepIsAsMuchCheaperAsItWas) {
  const Specimen wakeful = restingCube(kEdge, false, 0), sleepy = restingCube(kEdge, true, 0);
  const auto awake = onCpu(wakeful, 1), asleep = onCpu(sleepy, 1);
  settle(*awake, wakeful.scene, {}, kSettle_s);
  settle(*asleep, sleepy.scene, {}, kSettle_s);
  hold("awake over asleep", 1450, candidate("", awake, wakeful.nodes()), candidate("", asleep, sleepy.nodes()));
}

TEST(Guard, WhatASceneDoesNotHaveCostsNothing) {
  const std::map<std::string, double> nominal = {{"dashpot", 1.1},
                                                 {"strengths by part", 1},
                                                 {"contacts", 1},
                                                 {"cuts", 1},
                                                 {"cautery", 1},
                                                 {"bleeding", 1},
                                                 {"compensated sums", 1.1},
                                                 {"stability_monitor", 1},
                                                 {"cut state (one spring in every brick)", 1},
                                                 {"fixed nodes (half of them)", 1.9}};
  for (const Feature& feature : featuresOf(kEdge)) {
    ASSERT_EQ(nominal.count(feature.name), 1u) << feature.name;
    hold(feature.name + ", on over left out", nominal.at(feature.name), onOneThread(feature.with, feature.motions_with),
         onOneThread(feature.without), true);
  }
}

#endif

}  // namespace
}  // namespace viscera::bench
