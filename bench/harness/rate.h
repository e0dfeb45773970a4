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

/// Something that is timed.
struct Candidate {
  std::string name;
  double nodes = 0;              ///< that a substep advances
  std::function<double()> tick;  ///< @return substeps done
};

/// How fast it was.
struct Rate {
  double substeps_per_s = 0;      ///< median of the rounds
  double node_updates_per_s = 0;  ///< nodes times that
  double fastest_s = 0;           ///< of a substep, in the fastest round: what a busy machine disturbs least
  double spread = 0;              ///< of the rounds: (slowest - fastest) / median

  double ns_per_update() const { return 1e9 / node_updates_per_s; }
};

/// Times candidates in turn, a round after the other, so that what a machine does beside falls on all alike. Two ticks
/// of each warm up.
/// @param seconds  of every candidate in every round, at least one tick   @return [candidates]
std::vector<Rate> measureRates(const std::vector<Candidate>& candidates, double seconds, int rounds = 5);

/// Ticks of a solver, each until its measurements are on the host; motions are the same in all of them.
/// @param nodes  active ones
Candidate candidate(const std::string& name, std::shared_ptr<Solver> solver, size_t nodes,
                    const ToolMotions& motions = {});

/// The specimen on the CPU backend, at its start.
/// @param threads  0: as many as there are processors   @param simd  one of simdTargets(); empty: the best
std::shared_ptr<Ticks> onCpu(const Specimen& specimen, int threads = 0, const std::string& simd = {});
/// The specimen on the GPU backend, at its start.
std::shared_ptr<Ticks> onGpu(const Specimen& specimen);

}  // namespace viscera::bench
