// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "devices/device_profile.h"
#include "viscera/math/types.h"

namespace viscera {

/// Joints of a patient-side arm of the da Vinci, as the dVRK has them: yaw, pitch and insertion about the remote
/// centre, roll, and for a PSM wrist pitch and wrist yaw [rad, m]. An ECM has no wrist. Poses are those of the tip in
/// the base frame of the arm, with the remote centre as origin: z of the tip points out of the instrument. Joints of 0
/// point down, along -z of the base. The end of a PSM's shaft stays beyond the remote centre (kPsmLeastInsertion).
///
/// Lengths are those of the classic arms, modified Denavit-Hartenberg parameters (dVRK user guide;
/// sawIntuitiveResearchKit, psm-large-needle-driver and ecm): the PSM has a Large Needle Driver 400006.
class DaVinciArm {
 public:
  using Joints = std::vector<double>;
  static constexpr size_t kInsertion = 2;  ///< the joint that slides

  /// @param joints  of which arm; not kNone
  explicit DaVinciArm(ArmJoints joints);

  size_t count() const { return limits_.size(); }  ///< 6 for a PSM, 4 for an ECM
  const std::vector<std::string>& names() const { return names_; }
  /// Returns the pose of the tip. @param joints  count() values
  Pose tip(const Joints& joints) const;
  /// Returns the joints of a pose. A PSM reaches every orientation within its limits. The scope of an ECM has no
  /// wrist: position and roll count.
  /// @param near  joints from which the roll is continued   @return nothing: out of reach
  std::optional<Joints> reach(const Pose& tip, const Joints& near) const;
  /// Returns whether joints are finite, count() of them, and within the limits of the arm.
  bool isWithin(const Joints& joints) const;
  /// Returns the limits as text, for errors.
  std::string limitsText() const;

 private:
  struct Limit {
    double min, max;
  };
  Eigen::Matrix3d insertionFrame(double yaw, double pitch) const;

  bool has_wrist_;
  double to_wrist_m_;  ///< from the remote centre to the end of the shaft at an insertion of 0 [m]
  std::vector<Limit> limits_;
  std::vector<std::string> names_;
};

/// Returns the joints at a share of the way between two.
/// @param share  0: `from`, 1: `to`
DaVinciArm::Joints between(const DaVinciArm::Joints& from, const DaVinciArm::Joints& to, double share);

}  // namespace viscera
