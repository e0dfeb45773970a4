// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "solver/processes/tissue_points.h"
#include "viscera/model/model.h"
#include "viscera/solver/state.h"

namespace viscera {

/// Contact between the two sides of wounds: nodes with a cut spring come no nearer than they were at rest, so a stitch
/// closes a wound and no more. It is derived from the cuts alone and has no state.
class WoundLips {
 public:
  /// Largest number of pairs, that of a wound of about 20 x 20 spacings on each axis. Further pairs do not touch.
  static constexpr size_t kMostPairs = 2000;

  void find(const Model& model, const CutSprings& cuts);
  void addPoints(std::vector<const TissuePoint*>& points) const;
  /// Applies impulses between them at the end of a substep.
  void part(TissuePoints& points, double dt_s) const;
  size_t pairs() const { return pairs_.size(); }

 private:
  struct Pair {
    TissuePoint a, b;
    double apart_m;  ///< distance at rest
  };
  void add(const Model& model, uint32_t body, uint32_t a, uint32_t b);
  void addLattice(const Model& model, uint32_t body, const CutSprings& cuts);
  void addNetwork(const Model& model, uint32_t body, size_t first_spring, const CutSprings& cuts);

  std::vector<Pair> pairs_;
};

}  // namespace viscera
