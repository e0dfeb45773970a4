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

// Messages <-> core types: pure functions, no node needed. Everything is in metres, newtons and radians on both sides.

/// The pose as sent; the quaternion is copied, not normalised.
Pose fromMessage(const geometry_msgs::Pose& message);
geometry_msgs::Pose toMessage(const Pose& pose);
Pose fromMessage(const geometry_msgs::Transform& message);
geometry_msgs::TransformStamped toTransform(const Pose& pose, const std::string& parent, const std::string& child,
                                            const ros::Time& stamp);

std_msgs::Header toHeader(const std::string& frame, const ros::Time& stamp);
geometry_msgs::Vector3 toVector(const Vector3d& v);
geometry_msgs::Quaternion toQuaternion(const Quaterniond& q);
/// All seven numbers are finite.
bool isFinite(const Pose& pose);
/// Was a transform of something that moves true longer ago than that? Static ones have the stamp 0 and no age.
bool isOlder(const geometry_msgs::TransformStamped& transform, double age_s);

/// Force and torque in a frame that is turned by `frame_from_tissue` against the tissue frame. A reaction that is not
/// finite becomes zero: a device must never be sent one.
geometry_msgs::Wrench toMessage(const Reaction& reaction);
geometry_msgs::WrenchStamped toWrench(const Reaction& reaction, const Quaterniond& frame_from_tissue,
                                      const std::string& frame, const ros::Time& stamp);

/// Is it there, and has its kind two fingers?
bool hasJaws(const StylusMotion& tool);
/// Its joint `jaw`: position, the opening [rad]; effort, the moment that keeps them open about their pivot [N m].
sensor_msgs::JointState toJaw(const StylusMotion& tool, double moment_nm, const ros::Time& stamp);

/// tf2 refuses names with a leading slash, which drivers older than tf2 still send.
std::string tf2Name(const std::string& frame);
std::string toolFrame(const StylusConfig& stylus, const std::string& frame_prefix);

}  // namespace viscera::nodes
