// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <geometry_msgs/Pose.h>
#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <ros/time.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Header.h>

#include <string>

#include "viscera/math/types.h"
#include "viscera/tools/force_limiter.h"
#include "viscera/tools/stylus.h"

namespace viscera {
struct StylusConfig;
}  // namespace viscera

namespace viscera::nodes {

// Conversions between messages and core types: pure functions without a node. Both sides use metres, newtons and
// radians.

/// Returns the pose as sent; the quaternion is copied, not normalised.
Pose fromMessage(const geometry_msgs::Pose& message);
geometry_msgs::Pose toMessage(const Pose& pose);
Pose fromMessage(const geometry_msgs::Transform& message);
geometry_msgs::TransformStamped toTransform(const Pose& pose, const std::string& parent, const std::string& child,
                                            const ros::Time& stamp);

std_msgs::Header toHeader(const std::string& frame, const ros::Time& stamp);
geometry_msgs::Vector3 toVector(const Vector3d& v);
geometry_msgs::Quaternion toQuaternion(const Quaterniond& q);
/// Returns whether all seven numbers are finite.
bool isFinite(const Pose& pose);
/// Returns whether a transform is older than `age_s` [s]. Static transforms have the stamp 0 and no age.
bool isOlder(const geometry_msgs::TransformStamped& transform, double age_s);

/// Converts force and torque, with toWrench() into a frame that `frame_from_tissue` rotates against the tissue frame. A
/// reaction that is not finite becomes zero: a device must never receive one.
geometry_msgs::Wrench toMessage(const Reaction& reaction);
geometry_msgs::WrenchStamped toWrench(const Reaction& reaction, const Quaterniond& frame_from_tissue,
                                      const std::string& frame, const ros::Time& stamp);

/// Returns whether the tool is present and its kind has two fingers.
bool hasJaws(const StylusMotion& tool);
/// Returns the joint `jaw`: position is the opening angle [rad], effort the moment about the pivot that opens the jaws
/// [N m].
sensor_msgs::JointState toJaw(const StylusMotion& tool, double moment_nm, const ros::Time& stamp);

/// Returns a name without leading slashes: tf2 refuses them, and drivers older than tf2 still send them.
std::string tf2Name(const std::string& frame);
std::string toolFrame(const StylusConfig& stylus, const std::string& frame_prefix);

}  // namespace viscera::nodes
