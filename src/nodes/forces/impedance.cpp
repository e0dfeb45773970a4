// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/forces/impedance.h"

#include <algorithm>
#include <chrono>

#include "math/decompositions.h"
#include "nodes/ros/conversions.h"

namespace viscera::nodes {
namespace {

/// Returns the factor that limits the force at a position of the tip.
double shareAt(const ContactModel& model, const Vector3d& tip_m, SteadyTime now, double most_n, const ForcePort& port) {
  const double size_n = model.at(tip_m, std::chrono::duration<double>(now - SteadyTime{}).count()).force_n.norm();
  return shareWithin(port.scale * size_n, std::min(port.scale * most_n, port.max_force_n));
}

}  // namespace

crtk_msgs::CartesianImpedance noImpedance(const std::string& frame, const ros::Time& stamp) {
  crtk_msgs::CartesianImpedance out;
  out.header.frame_id = frame;
  out.header.stamp = stamp;
  out.force_orientation.w = out.torque_orientation.w = 1;
  return out;
}

crtk_msgs::CartesianImpedance toImpedance(const HapticServo& servo, const StylusMailbox& mailbox, double most_n,
                                          SteadyTime now, const ros::Time& stamp) {
  const DeviceFrame frame = mailbox.deviceFrame();
  const DeviceProfile& device = mailbox.device();
  const StylusSample stylus = mailbox.peek(now);
  crtk_msgs::CartesianImpedance out = noImpedance(frame.name, stamp);
  const ContactModel& model = servo.model();
  const Vector3d& normal = model.normal();
  const bool acts = stylus.valid && !mailbox.clutched() && model.kind() != TickContact::Kind::kFree;
  if (!acts || !(normal.squaredNorm() > 0)) return out;

  const Quaterniond axes = rotationBetween(Vector3d::UnitZ(), normal);
  const Matrix3d turn = axes.toRotationMatrix();
  Vector3d stiffness = (turn.transpose() * model.stiffness_n_per_m() * turn).diagonal();
  Vector3d bias_n = turn.transpose() * model.anchor_force_n(), position_m = model.anchor_m();
  const bool one_sided = model.kind() == TickContact::Kind::kPushes || model.kind() == TickContact::Kind::kPulls;
  if (one_sided) {
    if (!(stiffness.z() > 0)) return out;
    position_m += bias_n.z() / stiffness.z() * normal;
    bias_n.setZero();
    stiffness.x() = stiffness.y() = 0;
  }
  const double share = device.force.scale * shareAt(model, stylus.pose.position_m, now, most_n, device.force);
  stiffness *= share * device.scale;  // unit: newtons of the motors per metre of the device
  out.force_orientation = toQuaternion(frame.from_tissue * axes);
  out.force_position =
      toVector(device.pose.unit_m * mailbox.inDevice({position_m, stylus.pose.orientation}).position_m);
  out.position_negative.p = toVector(-stiffness);
  out.position_negative.d = toVector(-servo.lead_s() * stiffness);
  out.position_negative.bias = toVector(share * bias_n);
  if (!one_sided) out.position_positive = out.position_negative;
  return out;
}

}  // namespace viscera::nodes
