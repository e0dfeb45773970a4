// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include "solver/contact/collision.h"
#include "solver/contact/surroundings.h"
#include "solver/cpu/store/cpu_lattice.h"
#include "solver/cpu/store/parallel.h"
#include "solver/tissue/substep.h"

namespace viscera {

struct Scene;

class Archive;

/// Wind, forces on bodies, contacts and obstacles on the CPU: the text of shaders/solver/collision/surroundings.comp
/// and collision_*.comp, compiled as C++. See solver/gpu/contact/surroundings_pass.h.
class CpuSurroundings {
 public:
  /// Of collision.h's reach: how far two nodes may move relative to each other before the search begins again.
  static constexpr double kListMargin = 0.4;

  /// @param parallel  must outlive it   @param list_margin  0: searches in every substep; changes no bit
  /// @param most_in_bucket  kMostInBucket; a test may lower it
  CpuSurroundings(const Model& model, const Scene& scene, const CpuLattice& lattice, const Parallel& parallel,
                  double list_margin = kListMargin, uint32_t most_in_bucket = kMostInBucket);
  ~CpuSurroundings();
  /// Before an implicit substep: wind and forces change the velocities.
  void blow(CpuLattice& lattice, const Substep& step, const Surroundings& surroundings);
  /// current state -> other state, which becomes the current one. The other one must hold the state before the substep.
  /// After an implicit one contacts between nodes only.
  void run(CpuLattice& lattice, const Substep& step, const Surroundings& surroundings);
  /// The state was written from outside: what contacts did in the last substep is forgotten. Nodes that may touch
  /// no other any more, as their springs are whole again, would keep it for ever.
  void restart();
  void persist(Archive& archive);
  /// For tests: slots a < b of all pairs that the search finds in the current state, ascending.
  std::vector<CollisionPair> findPairs(CpuLattice& lattice);
  size_t searches() const;   ///< for candidates so far
  size_t compared() const;   ///< pairs that the last of these looked at
  uint32_t crowded() const;  ///< nodes that it passed over, as they lie in crowds (TickStats::crowded)

 private:
  struct Work;
  void collide(CpuLattice& lattice, const Substep& step);
  template <class Kernel>
  void apply(CpuLattice& lattice, const Substep& step, const Surroundings& surroundings);

  const Parallel& parallel_;
  SurroundingsFeatures kinds_;
  std::unique_ptr<Work> work_;
};

}  // namespace viscera
