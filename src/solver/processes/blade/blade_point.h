// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "solver/processes/blade/blade_kernel.h"
#include "viscera/layout/tool_motion.h"
#include "viscera/solver/solver.h"

namespace viscera {

class TissuePort;

/// The point of a blade or needle that is pushed along its axis: a contact with a plastic limit (docs/physics.md 10.4).
/// The area that it cuts is its width times its path. It cuts no springs: they are farther apart than it is wide.
class BladePoint {
 public:
  /// @param tissue  tissue to cut; must outlive it   @param width_m  CutConfig::point_width_m
  BladePoint(RestTissue& tissue, double width_m);

  /// Acts after a substep. @param blade  its motion in the substep
  /// @returns energy that it has stored in the tissue [J]; negative: energy that the tissue has spent on it
  double act(TissuePort& target, uint32_t stylus, const layout::ToolMotion& blade, double dt_s);
  void leave();
  void reset();
  const BladeWork& done() const { return done_; }
  void persist(Archive& archive);

 private:
  /// State that persists between substeps, as BladeEdge::Front.
  struct Tip {
    Vector3d at = Vector3d::Zero(), centre = Vector3d::Zero(), edge = Vector3d::Zero();
    Eigen::Matrix3d to_rest = Eigen::Matrix3d::Identity();
    uint32_t is_there = 0, stuck = 0;
  };

  void renewKernel(TissuePort& target);
  void makeKernel();
  void advance(const Vector3d& gap, const Vector3d& into, bool slips);
  double fill(const Vector3d& at_m) const;
  bool isInTissue() const { return fill(tip_.at) > 0; }

  RestTissue& tissue_;
  double width_m_, kernel_m_, h_;
  Tip tip_;
  BladeWork done_;
  BladeNodes near_;
  BladeKernel kernel_;
  RunPlanes momenta_;
  std::vector<float> spread_;
};

}  // namespace viscera
