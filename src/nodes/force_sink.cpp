// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/force_sink.h"

#include <geometry_msgs/WrenchStamped.h>
#include <std_msgs/Bool.h>

#include "nodes/conversions.h"
#include "nodes/foreign/geomagic_control.h"
#include "nodes/foreign/omni_msgs.h"

namespace viscera::nodes {
namespace {

constexpr uint32_t kNewest = 1;  ///< a queue in which the newest overtakes all others

ros::Publisher publisherOf(ros::NodeHandle& node, const ForcePort& port) {
  switch (port.type) {
    case ForceType::kNone:
      break;
    case ForceType::kWrenchStamped:
      return node.advertise<geometry_msgs::WrenchStamped>(port.topic, kNewest);
    case ForceType::kWrench:
      return node.advertise<geometry_msgs::Wrench>(port.topic, kNewest);
    case ForceType::kOmniFeedback:
      return node.advertise<foreign::OmniFeedback>(port.topic, kNewest);
    case ForceType::kGeomagicFeedback: {
      auto options = ros::AdvertiseOptions::create<foreign::GeomagicFeedback>(port.topic, kNewest, {}, {}, {}, nullptr);
      options.datatype = port.message;
      return node.advertise(options);
    }
  }
  return {};
}

/// A driver that is locked pulls to a place: the one where it is pulls nowhere.
template <class Message>
Message feedback(const geometry_msgs::Wrench& wrench, const Vector3d& position) {
  Message message;
  message.force = wrench.force;
  message.position = toVector(position);
  return message;
}

}  // namespace

Reaction toDevice(const Reaction& reaction, const DeviceFrame& frame, const ForcePort& port) {
  const Vector3d force_n = frame.from_tissue * (port.scale * reaction.force_n);
  const Vector3d torque_nm = frame.from_tissue * (port.scale * reaction.torque_nm) + frame.lever_arm_m.cross(force_n);
  double share = 1;
  if (force_n.norm() > port.max_force_n) share = port.max_force_n / force_n.norm();
  if (share * torque_nm.norm() > port.max_torque_nm) share = port.max_torque_nm / torque_nm.norm();
  return {share * force_n, share * torque_nm, reaction.saturated || share < 1};
}

ForceSink::ForceSink(ros::NodeHandle& node, const DeviceProfile& device)
    : port_(device.force), publisher_(publisherOf(node, port_)) {
  if (port_.absolute_topic.empty()) return;
  // A CRTK device takes a body wrench in its tip's frame unless told that it is in the frame of its poses.
  absolute_ = node.advertise<std_msgs::Bool>(port_.absolute_topic, kNewest, true);
  std_msgs::Bool absolute;
  absolute.data = true;
  absolute_.publish(absolute);
}

void ForceSink::send(const Reaction& reaction, const DeviceFrame& frame, const ros::Time& stamp) {
  constexpr double kMillimetresPerMetre = 1000;  // omni_common's poses are in metres, its lock in millimetres
  const geometry_msgs::WrenchStamped wrench =
      toWrench(toDevice(reaction, frame, port_), Quaterniond::Identity(), frame.name, stamp);
  switch (port_.type) {
    case ForceType::kNone:
      return;
    case ForceType::kWrenchStamped:
      return publisher_.publish(wrench);
    case ForceType::kWrench:
      return publisher_.publish(wrench.wrench);
    case ForceType::kOmniFeedback:
      return publisher_.publish(feedback<foreign::OmniFeedback>(wrench.wrench, kMillimetresPerMetre * frame.position));
    case ForceType::kGeomagicFeedback:
      return publisher_.publish(feedback<foreign::GeomagicFeedback>(wrench.wrench, frame.position));
  }
}

}  // namespace viscera::nodes
