// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/impedance.h"

#include "nodes/conversions.h"

namespace viscera::nodes {

foreign::CartesianImpedance noImpedance(const std::string& frame, const ros::Time& stamp) {
  foreign::CartesianImpedance out;
  out.header.frame_id = frame;
  out.header.stamp = stamp;
  out.force_orientation.w = out.torque_orientation.w = 1;
  return out;
}

foreign::CartesianImpedance toImpedance(const HapticServo& servo, const std::string& frame, const ros::Time& stamp) {
  foreign::CartesianImpedance out = noImpedance(frame, stamp);
  const ContactModel& model = servo.model();
  const Vector3d& normal = model.normal();
  if (model.kind() == TickContact::Kind::kFree || !(normal.squaredNorm() > 0)) return out;
  const Quaterniond axes = Quaterniond::FromTwoVectors(Vector3d::UnitZ(), normal);
  const Matrix3d turn = axes.toRotationMatrix();
  Vector3d stiffness = (turn.transpose() * model.stiffness_n_per_m() * turn).diagonal();
  Vector3d bias = turn.transpose() * model.anchor_force_n(), place = model.anchor_m();
  if (model.kind() == TickContact::Kind::kPushes) {
    if (!(stiffness.z() > 0)) return out;
    place += bias.z() / stiffness.z() * normal;
    bias.setZero();
    stiffness.x() = stiffness.y() = 0;
  }
  out.force_orientation = toQuaternion(axes);
  out.force_position = toVector(place);
  out.position_negative.p = toVector(-stiffness);
  out.position_negative.d = toVector(-servo.lead_s() * stiffness);
  out.position_negative.bias = toVector(bias);
  if (model.kind() == TickContact::Kind::kHolds) out.position_positive = out.position_negative;
  return out;
}

}  // namespace viscera::nodes
