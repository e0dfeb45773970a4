// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "viscera/model/body/spacing_choice.h"

namespace viscera {

namespace gpu {
class Context;
}

/// What a substep took of a lattice of so many nodes.
struct TimedSubstep {
  double nodes = 0, seconds = 0;
};

/// The straight line through two measurements. Where it makes no sense, as with caches that overflow or a machine that
/// did something else meanwhile: in proportion to the nodes, as long as the larger one took.
StepTime stepTimeThrough(const TimedSubstep& small, const TimedSubstep& large);

/// How fast this machine steps the bodies of a scene whose spacing is `auto`, with the scene's backend, integrator,
/// tools and governor, measured on coarse lattices of theirs in some tenths of a second.
/// @param context  current on this thread, or null: there is none, and the CPU is measured
StepTime measureStepTime(const UndividedBodies& bodies, const Scene& scene, const gpu::Context* context);

/// All that the measurement depends on, in one line: version, machine, backend, threads, features, bodies' shapes.
std::string stepTimeKey(const Scene& scene, const gpu::Context* context);

/// Measurements that are kept from one process to the next: lines of key, overhead_s and per_node_s in a small file. A
/// folder that cannot be written or a file that makes no sense is no error: then it is measured again.
class StepTimeCache {
 public:
  /// @param folder  empty: keeps nothing
  explicit StepTimeCache(const std::string& folder);
  /// In $XDG_CACHE_HOME/viscera, else ~/.cache/viscera.
  static StepTimeCache ofUser();
  /// The same for someone who measures on a machine that does something else meanwhile: what is there is found, and
  /// nothing is kept.
  StepTimeCache asItIs() const;

  const std::string& file() const { return file_; }
  std::optional<StepTime> find(const std::string& key) const;
  void keep(const std::string& key, const StepTime& time) const;

 private:
  std::string file_;
  bool keeps_ = true;
};

}  // namespace viscera
