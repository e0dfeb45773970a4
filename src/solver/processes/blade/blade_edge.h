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

/// The edge of one blade in one body: a contact line with a plastic limit (docs/cutting.md). Each of its samples has a
/// front, a position in the tissue at rest. Below the limit a front sticks, and the edge pushes the tissue ahead of it.
/// At the limit the front advances through the tissue, and what the fronts sweep at rest is cut. The work is toughness
/// times area at any spacing.
class BladeEdge {
 public:
  /// @param tissue  tissue to cut; must outlive it   @param friction_n_per_m  CutConfig
  BladeEdge(RestTissue& tissue, double friction_n_per_m);

  /// Acts after a substep. @param blade  its motion in the substep
  void act(TissuePort& target, uint32_t stylus, const layout::ToolMotion& blade, double dt_s);
  /// Ends the contact when the blade is gone or the state was restored: fronts start over. @returns whether there were
  /// any
  bool leave(TissuePort& target);
  void reset();
  /// Adds energy that the point of the same blade has stored in the tissue: the edge may return it to the user too.
  /// @param more_j  negative: it was spent
  void addStored(double more_j) { stored_j_ = std::max(0.0, stored_j_ + more_j); }
  const BladeWork& done() const { return done_; }
  void persist(Archive& archive);

 private:
  /// State of a sample of the edge that persists between substeps. Positions are in the tissue frame, those of fronts
  /// at rest [m].
  struct Front {
    Vector3d at = Vector3d::Zero();                         ///< position of the front
    Vector3d centre = Vector3d::Zero();                     ///< centre of its kernel
    Vector3d gathered = Vector3d::Zero();                   ///< position of the front when nodes were gathered
    Vector3d cut = Vector3d::Zero();                        ///< position up to which springs are cut
    Vector3d edge = Vector3d::Zero();                       ///< position of the sample
    Vector3d forward = Vector3d::Zero();                    ///< direction into the tissue ahead, across the edge
    Vector3d travel = Vector3d::Zero();                     ///< recent displacement of the sample
    Eigen::Matrix3d to_rest = Eigen::Matrix3d::Identity();  ///< inverse of F at the last update of the kernel
    uint32_t stuck = 0;  ///< 1: in tissue that is whole ahead; 0: in air or in a wound
    uint32_t cuts = 0;   ///< was stuck at some time since springs were last cut
  };
  /// Share of the edge between two samples that one of them represents.
  struct Share {
    double fill = 0;                 ///< share that is tissue
    RestToughness::Carried carried;  ///< carried toughness times that
    void add(double more, const RestToughness::Carried& there) {
      fill += more;
      carried.inside_j_per_m2 += more * there.inside_j_per_m2;
      carried.at_surface_j_per_m2 += more * there.at_surface_j_per_m2;
    }
  };
  /// Data of a substep.
  struct Push {
    Vector3d edge_velocity = Vector3d::Zero();
    Vector3d gap = Vector3d::Zero();  ///< vector from the front to the edge before the substep, in the current tissue
    Vector3d velocity = Vector3d::Zero();  ///< velocity of the tissue
    Vector3d impulse = Vector3d::Zero();   ///< impulse on the tissue [N s], including rub
    Vector3d rub = Vector3d::Zero();       ///< friction of the blade's sides
    Vector3d side = Vector3d::Zero();      ///< normal of the blade's plane
    Vector3d of_tool = Vector3d::Zero();   ///< direction of the tool's motion in the plane
    double length_m = 0, cap_n_s = 0;
    double yield_n_s = 0;                ///< limit in the plane, reduced for a drawn blade
    RestToughness::Carried over_length;  ///< toughness times length [N]
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
  void sense(double dt_s);
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
  static Vector3d alongMotion(const Vector3d& of_tool, const Vector3d& in_plane);
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
  double drawnBy(const Vector3d& travel) const;
  double ahead(size_t i) const;
  double toughness(size_t i) const;

  RestTissue& tissue_;
  double friction_n_per_m_, kernel_m_, h_;
  std::vector<Front> fronts_;  ///< samples from the near end of the blade to the far one; empty: there is no blade
  BladeWork done_;
  double stored_j_ = 0;  ///< bound on the energy that this edge stored in the tissue in this stroke, and may return
  std::vector<BladeKernel> kernels_;
  std::vector<std::array<Share, 2>> shares_;  ///< shares of a sample and the next between them
  std::vector<Push> pushes_;
  std::vector<double> mobilities_;  ///< [samples^2] change of one's velocity per impulse of another [1/kg]
  BladeNodes near_;
  RunPlanes momenta_;  ///< momenta of near_; then changes of velocities
  std::vector<float> spread_;
  Vector3d near_along_ = Vector3d::Zero();  ///< direction of the edge when near_ was gathered
  Vector3d along_ = Vector3d::Zero();       ///< direction of the edge
};

}  // namespace viscera
