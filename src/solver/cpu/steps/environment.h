// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "solver/contact/collision.h"
#include "solver/contact/environment.h"
#include "solver/cpu/state/cpu_lattice.h"
#include "solver/cpu/state/parallel.h"
#include "solver/tissue/substep.h"

namespace viscera {

struct Scene;

class Archive;

/// Wind, forces on bodies, contacts and obstacles on the CPU: the text of shaders/solver/collision/environment.comp and
/// collision_*.comp, compiled as C++. See solver/gpu/contact/environment_pass.h.
class CpuEnvironment {
 public:
  /// Share of collision.h's reach by which two nodes may move relative to each other before the next search.
  static constexpr double kListMargin = 0.4;

  /// @param parallel  must outlive this
  /// @param list_margin  0: searches in every substep; the results are the same to the bit
  /// @param most_in_bucket  kMostInBucket; a test may lower it
  CpuEnvironment(const Model& model, const Scene& scene, const CpuLattice& lattice, const Parallel& parallel,
                 double list_margin = kListMargin, uint32_t most_in_bucket = kMostInBucket);
  ~CpuEnvironment();
  /// Adds wind and forces to the velocities, before an implicit substep.
  void blow(CpuLattice& lattice, const Substep& step, const Environment& environment);
  /// Steps from the current state to the other one, which becomes the current one. The other one must hold the state
  /// before the substep. After an implicit substep, applies contacts between nodes only.
  void run(CpuLattice& lattice, const Substep& step, const Environment& environment);
  /// Clears the effects of contacts of the last substep after an external write to the state. Otherwise nodes that can
  /// no longer touch others, since their springs are intact again, would keep them.
  void restart();
  void persist(Archive& archive);
  /// Returns the slots a < b of all pairs that the search finds in the current state, ascending. For tests.
  std::vector<CollisionPair> findPairs(CpuLattice& lattice);
  size_t searches() const;   ///< number of searches for candidates so far
  size_t compared() const;   ///< pairs that the last search compared
  uint32_t crowded() const;  ///< nodes that it skipped as crowded (TickStats::crowded)

 private:
  struct Work;
  void collide(CpuLattice& lattice, const Substep& step);
  template <class Kernel>
  void apply(CpuLattice& lattice, const Substep& step, const Environment& environment);

  const Parallel& parallel_;
  EnvironmentFeatures kinds_;
  std::unique_ptr<Work> work_;
};

}  // namespace viscera
