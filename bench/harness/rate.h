// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/harness/specimens/specimen.h"
#include "calibration/timed_ticks.h"

namespace viscera::bench {

/// Something to be timed.
struct Candidate {
  std::string name;
  double nodes = 0;              ///< number of nodes that a substep advances
  std::function<double()> tick;  ///< runs a tick; @return number of substeps
};

/// The measured speed of a candidate.
struct Rate {
  double substeps_per_s = 0;      ///< median of the rounds
  double node_updates_per_s = 0;  ///< nodes times the above
  double fastest_s = 0;           ///< fastest substep of all rounds [s], the least affected by other load
  double spread = 0;              ///< spread of the rounds: (slowest - fastest) / median

  double ns_per_update() const { return 1e9 / node_updates_per_s; }
};

/// Times candidates in turn, one round after another, so that other load of the machine affects all alike. Two ticks of
/// each warm up.
/// @param seconds  time for every candidate in every round, at least one tick   @return [candidates]
std::vector<Rate> measureRates(const std::vector<Candidate>& candidates, double seconds, int rounds = 5);

/// Returns a candidate that steps a solver with constant motions. Each tick waits until its measurements are on the
/// host.
/// @param nodes  number of active nodes
Candidate candidate(const std::string& name, std::shared_ptr<Solver> solver, size_t nodes,
                    const ToolMotions& motions = {});

/// Creates the specimen on the CPU backend, in its initial state.
/// @param threads  0: number of CPU cores   @param simd  one of simdTargets(); empty: the best
std::shared_ptr<TissueStepper> onCpu(const Specimen& specimen, int threads = 0, const std::string& simd = {});
/// Creates the specimen on the GPU backend, in its initial state.
std::shared_ptr<TissueStepper> onGpu(const Specimen& specimen);

}  // namespace viscera::bench
