// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/forces/force_sink.h"

#include <std_msgs/Bool.h>

#include "nodes/input/force_messages.h"
#include "nodes/ros/conversions.h"

namespace viscera::nodes {

Reaction toDevice(const Reaction& reaction, const DeviceFrame& frame, const ForcePort& port) {
  const Vector3d force_n = frame.from_tissue * (port.scale * reaction.force_n);
  Vector3d torque_nm = frame.from_tissue * (port.scale * reaction.torque_nm) + frame.lever_arm_m.cross(force_n);
  if (!hasTorque(port) || port.max_torque_nm == 0) torque_nm.setZero();
  const double share = shareWithin(force_n, torque_nm, port.max_force_n, port.max_torque_nm);
  return {share * force_n, share * torque_nm, reaction.saturated || share < 1};
}

ForceSink::ForceSink(ros::NodeHandle& node, const DeviceProfile& device) : port_(device.force) {
  withForceMessage(port_.type,
                   [&](auto message) { publisher_ = advertiseForce<decltype(message)>(node, port_.topic, port_); });
  if (port_.absolute_topic.empty()) return;
  // CRTK devices interpret a body wrench in the frame of their tip unless this topic selects the frame of their poses.
  absolute_ = node.advertise<std_msgs::Bool>(port_.absolute_topic, 1, true);
  std_msgs::Bool absolute;
  absolute.data = true;
  absolute_.publish(absolute);
}

Reaction ForceSink::send(const Reaction& reaction, const DeviceFrame& frame, const ros::Time& stamp) {
  const Reaction sent = toDevice(reaction, frame, port_);
  const geometry_msgs::WrenchStamped wrench = toWrench(sent, Quaterniond::Identity(), frame.name, stamp);
  withForceMessage(port_.type, [&](auto message) {
    setForce(message, wrench, frame.position);
    publisher_.publish(message);
  });
  return sent;
}

}  // namespace viscera::nodes
