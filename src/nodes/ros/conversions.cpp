// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/ros/conversions.h"

#include "model/scene/tool_kinds.h"

namespace viscera::nodes {

std_msgs::Header toHeader(const std::string& frame, const ros::Time& stamp) {
  std_msgs::Header out;
  out.frame_id = frame;
  out.stamp = stamp;
  return out;
}

geometry_msgs::Vector3 toVector(const Vector3d& v) {
  geometry_msgs::Vector3 out;
  out.x = v.x(), out.y = v.y(), out.z = v.z();
  return out;
}

geometry_msgs::Quaternion toQuaternion(const Quaterniond& q) {
  geometry_msgs::Quaternion out;
  out.x = q.x(), out.y = q.y(), out.z = q.z(), out.w = q.w();
  return out;
}

Pose fromMessage(const geometry_msgs::Pose& message) {
  const auto& q = message.orientation;
  return {{message.position.x, message.position.y, message.position.z}, Quaterniond(q.w, q.x, q.y, q.z)};
}

Pose fromMessage(const geometry_msgs::Transform& message) {
  const auto& q = message.rotation;
  return {{message.translation.x, message.translation.y, message.translation.z}, Quaterniond(q.w, q.x, q.y, q.z)};
}

geometry_msgs::Pose toMessage(const Pose& pose) {
  geometry_msgs::Pose out;
  out.position.x = pose.position_m.x(), out.position.y = pose.position_m.y(), out.position.z = pose.position_m.z();
  out.orientation = toQuaternion(pose.orientation);
  return out;
}

geometry_msgs::TransformStamped toTransform(const Pose& pose, const std::string& parent, const std::string& child,
                                            const ros::Time& stamp) {
  geometry_msgs::TransformStamped out;
  out.header = toHeader(parent, stamp);
  out.child_frame_id = child;
  out.transform.translation = toVector(pose.position_m);
  out.transform.rotation = toQuaternion(pose.orientation);
  return out;
}

bool isFinite(const Pose& pose) {
  return pose.position_m.allFinite() && pose.orientation.coeffs().allFinite();
}

bool isOlder(const geometry_msgs::TransformStamped& transform, double age_s) {
  const ros::Time& stamp = transform.header.stamp;
  return !stamp.isZero() && ros::Time::now().toSec() - stamp.toSec() > age_s;
}

geometry_msgs::Wrench toMessage(const Reaction& reaction) {
  geometry_msgs::Wrench out;
  out.force = toVector(reaction.force_n);
  out.torque = toVector(reaction.torque_nm);
  return out;
}

geometry_msgs::WrenchStamped toWrench(const Reaction& reaction, const Quaterniond& frame_from_tissue,
                                      const std::string& frame, const ros::Time& stamp) {
  geometry_msgs::WrenchStamped out;
  out.header = toHeader(frame, stamp);
  if (!reaction.force_n.allFinite() || !reaction.torque_nm.allFinite()) return out;
  out.wrench = toMessage({frame_from_tissue * reaction.force_n, frame_from_tissue * reaction.torque_nm, false});
  return out;
}

bool hasJaws(const StylusMotion& tool) {
  return tool.present && kindOf(tool.mode).jaws;
}

sensor_msgs::JointState toJaw(const StylusMotion& tool, double moment_nm, const ros::Time& stamp) {
  sensor_msgs::JointState message;
  message.header.stamp = stamp;
  message.name = {"jaw"};
  message.position = {tool.opens_to_rad};
  message.effort = {moment_nm};
  return message;
}

std::string tf2Name(const std::string& frame) {
  return !frame.empty() && frame.front() == '/' ? frame.substr(1) : frame;
}

std::string toolFrame(const StylusConfig& stylus, const std::string& frame_prefix) {
  return frame_prefix + stylus.name + "_tool";
}

}  // namespace viscera::nodes
