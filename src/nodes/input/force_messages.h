// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <geomagic_control/DeviceFeedback.h>
#include <geometry_msgs/Wrench.h>
#include <geometry_msgs/WrenchStamped.h>
#include <omni_msgs/OmniFeedback.h>
#include <ros/node_handle.h>
#include <ros/time.h>

#include <string>
#include <type_traits>

#include "devices/device_profile.h"
#include "nodes/ros/conversions.h"

namespace viscera::nodes {

// Message types in which drivers take forces: for each, how to set a wrench and how to set zero force.

/// Fills a message from a wrench. A locked driver pulls towards the position in its last message, so the message has
/// the device's current position.
/// @param position  position of the device's last pose, in its own unit
inline void setForce(geometry_msgs::WrenchStamped& out, const geometry_msgs::WrenchStamped& wrench, const Vector3d&) {
  out = wrench;
}
inline void setForce(geometry_msgs::Wrench& out, const geometry_msgs::WrenchStamped& wrench, const Vector3d&) {
  out = wrench.wrench;
}
inline void setForce(omni_msgs::OmniFeedback& out, const geometry_msgs::WrenchStamped& wrench,
                     const Vector3d& position) {
  constexpr double kMillimetresPerMetre = 1000;  // omni_common has poses in metres but lock positions in millimetres
  out.force = wrench.wrench.force;
  out.position = toVector(kMillimetresPerMetre * position);
}
inline void setForce(geomagic_control::DeviceFeedback& out, const geometry_msgs::WrenchStamped& wrench,
                     const Vector3d& position) {
  out.force = wrench.wrench.force;
  out.position = toVector(position);
  out.lock.assign(3, false);
}

/// Removes the force from a message; the position of a lock stays.
inline void setZero(geometry_msgs::WrenchStamped& out) {
  out.wrench = {};
  out.header.stamp = ros::Time::now();
}
inline void setZero(geometry_msgs::Wrench& out) {
  out = {};
}
inline void setZero(omni_msgs::OmniFeedback& out) {
  out.force = {};
}
inline void setZero(geomagic_control::DeviceFeedback& out) {
  out.force = {};
}

/// Calls `use` with an empty message of the type; does not call it for a device without forces.
template <class Use>
void withForceMessage(ForceType type, const Use& use) {
  switch (type) {
    case ForceType::kNone:
      return;
    case ForceType::kWrenchStamped:
      return use(geometry_msgs::WrenchStamped());
    case ForceType::kWrench:
      return use(geometry_msgs::Wrench());
    case ForceType::kOmniFeedback:
      return use(omni_msgs::OmniFeedback());
    case ForceType::kGeomagicFeedback:
      return use(geomagic_control::DeviceFeedback());
  }
}

/// Returns the name by which a driver knows the message.
template <class Message>
std::string forceDatatype(const ForcePort& port) {
  if (std::is_same<Message, geomagic_control::DeviceFeedback>::value) return port.message;
  return ros::message_traits::datatype<Message>();
}

/// Advertises a topic of forces with a queue of one message, in which the newest replaces older ones.
template <class Message>
ros::Publisher advertiseForce(ros::NodeHandle& node, const std::string& topic, const ForcePort& port) {
  auto options = ros::AdvertiseOptions::create<Message>(topic, 1, {}, {}, {}, nullptr);
  options.datatype = forceDatatype<Message>(port);
  return node.advertise(options);
}

}  // namespace viscera::nodes
