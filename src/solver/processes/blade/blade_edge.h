// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "solver/processes/blade/blade_kernel.h"
#include "solver/processes/port.h"
#include "viscera/layout/tool_motion.h"
#include "viscera/math/types.h"
#include "viscera/solver/blade_work.h"

namespace viscera {

/// The edge of one blade in one body, a contact line with a plastic limit (docs/cutting.md). Its samples have fronts,
/// places in the tissue at rest: below the limit a front is stuck, and the edge pushes the tissue before it; at the
/// limit it is moved on through the tissue, and what the fronts sweep at rest is cut. The work is toughness times area
/// whatever the spacing.
class BladeEdge {
 public:
  /// @param tissue  that it cuts; must outlive it   @param friction_n_per_m  CutConfig
  BladeEdge(RestTissue& tissue, double friction_n_per_m);

  /// After a substep. @param blade  its motion in the substep
  void act(TissuePort& target, uint32_t stylus, const layout::ToolMotion& blade, double dt_s);
  /// The blade is not there, or the state was put back: fronts begin again. @returns whether there were any
  bool leave(TissuePort& target);
  void reset();
  /// What the point of the same blade has stored in the tissue: a hand may get it back from the edge too. @param more_j
  /// below 0: it was spent
  void addStored(double more_j) { stored_j_ = std::max(0.0, stored_j_ + more_j); }
  const BladeWork& done() const { return done_; }
  void persist(Archive& archive);

 private:
  /// Of a sample of the edge, what is kept from substep to substep. Places are in the tissue frame, those of fronts at
  /// rest [m].
  struct Front {
    Vector3d at = Vector3d::Zero();                         ///< the front
    Vector3d centre = Vector3d::Zero();                     ///< where its kernel was made
    Vector3d gathered = Vector3d::Zero();                   ///< where it was when nodes were gathered
    Vector3d cut = Vector3d::Zero();                        ///< up to where springs are cut
    Vector3d edge = Vector3d::Zero();                       ///< where the sample is
    Vector3d forward = Vector3d::Zero();                    ///< into the tissue ahead, across the edge
    Vector3d way = Vector3d::Zero();                        ///< of the sample, lately
    Eigen::Matrix3d to_rest = Eigen::Matrix3d::Identity();  ///< the inverse of F, when the kernel was new
    uint32_t stuck = 0;  ///< in tissue that is whole ahead; else it is in the air or in a wound
    uint32_t cuts = 0;   ///< was stuck since springs were cut last
  };
  /// Of the edge between two samples, what one of them stands for.
  struct Share {
    double fill = 0;                 ///< as tissue
    RestToughness::Carried carried;  ///< times that
    void add(double more, const RestToughness::Carried& there) {
      fill += more;
      carried.inside_j_per_m2 += more * there.inside_j_per_m2;
      carried.at_surface_j_per_m2 += more * there.at_surface_j_per_m2;
    }
  };
  /// Of a substep.
  struct Push {
    Vector3d edge_velocity = Vector3d::Zero();
    Vector3d gap = Vector3d::Zero();       ///< from the front to the edge as they are, before the substep
    Vector3d velocity = Vector3d::Zero();  ///< of the tissue
    Vector3d impulse = Vector3d::Zero();   ///< on the tissue [N s], rub among it
    Vector3d rub = Vector3d::Zero();       ///< of the blade's walls
    Vector3d side = Vector3d::Zero();      ///< across the blade's plane
    Vector3d of_hand = Vector3d::Zero();   ///< the hand's way in it
    double length_m = 0, cap_n_s = 0;
    double gives_way_n_s = 0;            ///< in the plane: the limit of a blade that is drawn
    RestToughness::Carried over_length;  ///< times length [N]
    bool slips = false, aside = false;
    void stand(double all_m, const Share& share) {
      length_m += all_m * share.fill;
      over_length.inside_j_per_m2 += all_m * share.carried.inside_j_per_m2;
      over_length.at_surface_j_per_m2 += all_m * share.carried.at_surface_j_per_m2;
    }
  };

  void place(const layout::ToolMotion& blade);
  void aim(const layout::ToolMotion& blade, double dt_s);
  void renewKernels();
  void gather();
  void findMobilities();
  void look(double dt_s);
  void findShares(size_t i);
  void findLengths();
  int stripsOf(double length_m) const;
  double partedPerSwept(size_t i) const;
  void limit(size_t i);
  void solve(double dt_s);
  void solveOne(size_t i, double dt_s);
  void rubOne(size_t i, double dt_s);
  void give(size_t i, const Vector3d& impulse);
  Vector3d limited(size_t i, const Vector3d& impulse);
  static Vector3d alongWay(const Vector3d& of_hand, const Vector3d& in_plane);
  void giveBackAtMost();
  void give(TissuePort& target, uint32_t stylus, double dt_s);
  void advance(double dt_s);
  void moveFront(size_t i, const Vector3d& gap);
  void followThroughAir();
  bool cutsBetween(size_t i) const { return fronts_[i].cuts || fronts_[i + 1].cuts; }  ///< a sample and the next one
  Vector3d startOf(const Front& front) const;
  bool isStraight(size_t first, size_t last) const;
  void cutBehind(TissuePort& target, bool all);
  void countArea(size_t i, const Vector3d& step);
  void stickAgain();
  bool goesIntoWhole(size_t i, const Vector3d& ahead, const Vector3d& side) const;
  bool isWhole(const Vector3d& ahead, const Vector3d& side) const;
  Vector3d toRest(size_t i, const Vector3d& gap) const;
  double drawnBy(const Vector3d& way) const;
  double ahead(size_t i) const;
  double toughness(size_t i) const;

  RestTissue& tissue_;
  double friction_n_per_m_, kernel_m_, h_;
  std::vector<Front> fronts_;  ///< from the near end of the blade to the far one; empty: the blade is not there
  BladeWork done_;
  double stored_j_ = 0;  ///< in the tissue by this edge since it came, at most: what it may give back
  std::vector<BladeKernel> kernels_;
  std::vector<std::array<Share, 2>> shares_;  ///< between a sample and the next: of either, as kernels were made
  std::vector<Push> pushes_;
  std::vector<double> mobilities_;  ///< [samples^2] what an impulse of one changes another's velocity by [1/kg]
  BladeNodes near_;
  RunPlanes momenta_;  ///< of those; then what they change velocities by
  std::vector<float> spread_;
  Vector3d near_along_ = Vector3d::Zero();  ///< the edge's direction when they were gathered
  Vector3d along_ = Vector3d::Zero();       ///< the edge's direction
};

}  // namespace viscera
