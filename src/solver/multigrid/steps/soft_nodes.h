// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "solver/multigrid/steps/stage_solver.h"

namespace viscera::multigrid {

/// Nodes that hang on cells of which next to nothing is tissue. The springs of such cells and what moments take off
/// them nearly cancel: in strained tissue the curvature of the energy is about 0 there, of either sign, and a step of
/// Newton's method would throw these nodes as far as it likes. What the rest of the tissue does hardly depends on them.
///
/// In the systems of all nodes their springs are stiffened by a share of their own (K. Levenberg, Quart. Appl. Math. 2,
/// 1944; D. W. Marquardt, J. SIAM 11, 1963). What they lack then is relaxed by Newton's method among them alone, the
/// rest held, at the cost of the few blocks of places that they lie in; each has a share of its own there, by how well
/// its forces were foreseen.
class SoftNodes final : public Stiffening {
 public:
  explicit SoftNodes(StageSolver& solver);

  bool any() const { return !nodes_.empty(); }
  void addTo(const Vectors& p, Vectors& q) const override;
  void sagged() override;
  /// What a step of all nodes did to the norm of the residual: where that was little, the share is what holds it up.
  void learn(double before_n, double after_n);
  /// Relaxes those that are out of balance. After StageSolver::residual(increment).
  /// @param norm_n  of that residual   @param enough_n  norm that theirs may have
  /// @return something moved: forces must be asked for again
  bool relax(Vectors& increment, double norm_n, double enough_n);

 private:
  struct Spring {
    uint32_t far;  ///< place
    float stiffness_n_per_m;
  };
  size_t placeOf(uint32_t soft) const { return solver_.level.grid().place_of[nodes_[soft]]; }
  float spacingOf(uint32_t soft) const {
    return solver_.level.box(solver_.level.grid().bodyOf(nodes_[soft])).params.origin_spacing.w;
  }
  void addSprings(uint32_t soft, float share, const Vectors& p, Vectors& q) const;
  double choose(double enough_n);
  void relaxChosen();
  double balance();
  void solve();
  bool step();
  void bound();
  void trust();
  void multiply(const Vectors& p, Vectors& q);
  double dot(const Vectors& a, const Vectors& b) const;
  template <class Each>
  void forNumbers(const Each& each) const;

  StageSolver& solver_;
  std::vector<uint32_t> nodes_;   ///< of the grid
  std::vector<uint32_t> starts_;  ///< [nodes + 1] of their springs
  std::vector<Spring> springs_;
  std::vector<int32_t> soft_at_;  ///< [nodes of the grid] soft node, -1 none
  std::vector<float> share_;      ///< [soft nodes] of their springs that is added where they are by themselves
  std::vector<uint32_t> chosen_;  ///< soft nodes that are relaxed
  Region region_;
  float common_share_;  ///< of all springs in systems of all nodes
  Vectors u_, r_, last_r_, s_, p_, q_, z_, force_;
};

}  // namespace viscera::multigrid
