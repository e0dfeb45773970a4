// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <future>
#include <memory>
#include <vector>

#include "solver/multigrid/levels/hierarchy.h"

namespace viscera::multigrid {

/// Hierarchies of the stages that were solved so far: kinds of steps take turns, and each has its own.
class BuiltLevels {
 public:
  /// Levels and the stage that they were built for.
  struct Built {
    Stage stage;
    std::shared_ptr<Hierarchy> hierarchy;
    float largest = 0;  ///< as largestOf(), at rest
  };

  /// Those for a stage; made, if none are good enough for it. @param level  may be linearised at rest
  const Built& of(FineLevel& level, const Stage& stage);
  /// Begins to build them of the level as it is now, on a thread of its own; takeRebuilt() waits for it and takes them
  /// in place of all others.
  void rebuildAside(FineLevel& level);
  bool takeRebuilt();  ///< @return there were any

 private:
  std::vector<Built> built_;
  std::future<Built> rebuilt_;
};

}  // namespace viscera::multigrid
