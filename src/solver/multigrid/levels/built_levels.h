// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <future>
#include <memory>
#include <vector>

#include "solver/multigrid/levels/hierarchy.h"

namespace viscera {
class Archive;
}

namespace viscera::multigrid {

/// Hierarchies of the stages that were solved so far: kinds of steps take turns, and each has its own.
class BuiltLevels {
 public:
  /// Levels and the stage that they were built for.
  struct Built {
    Stage stage;
    std::shared_ptr<Hierarchy> hierarchy;
    float largest = 0;                 ///< as largestOf(), at rest
    FineLevel::Nodes nodes = nullptr;  ///< of the level when the hierarchy was built
  };

  /// Those for a stage; made, if none are good enough for it. @param level  may be linearised at rest
  const Built& of(FineLevel& level, const Stage& stage);
  /// Begins to build them of the level as it is now, on a thread of its own; takeRebuilt() waits for it and takes them
  /// in place of all others.
  void rebuildAside(FineLevel& level);
  bool takeRebuilt();  ///< @return there were any
  /// Levels are not kept: they are built again, of the nodes that they were built of.
  /// @param level, lattice  that are looked at; where it is read the nodes are afterwards those that the level knew
  void persist(Archive& archive, FineLevel& level, CpuLattice& lattice);

 private:
  void persist(Archive& archive, FineLevel& level, CpuLattice& lattice, std::vector<Built>& built);

  std::vector<Built> built_;
  std::future<Built> rebuilt_;
};

}  // namespace viscera::multigrid
