// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <geometry_msgs/Quaternion.h>
#include <geometry_msgs/Vector3.h>
#include <std_msgs/Header.h>

#include <type_traits>

#include "nodes/foreign/foreign_message.h"

namespace viscera::nodes::foreign {

/// crtk_msgs/CartesianImpedanceHalfPlaneGains: along each axis, for one side of it, force = bias + p e + d v.
struct CartesianImpedanceGains {
  geometry_msgs::Vector3 p, d, bias, deadband;
  template <class Stream, class Message>
  static void fields(Stream& stream, Message& message) {
    stream.next(message.p);
    stream.next(message.d);
    stream.next(message.bias);
    stream.next(message.deadband);
  }
};

/// crtk_msgs/CartesianImpedance: e is where the tip is from force_position, along the axes of force_orientation.
struct CartesianImpedance {
  std_msgs::Header header;
  geometry_msgs::Quaternion force_orientation;
  geometry_msgs::Vector3 force_position;
  geometry_msgs::Quaternion torque_orientation;
  CartesianImpedanceGains position_positive, position_negative, orientation_positive, orientation_negative;
  template <class Stream, class Message>
  static void fields(Stream& stream, Message& message) {
    stream.next(message.header);
    stream.next(message.force_orientation);
    stream.next(message.force_position);
    stream.next(message.torque_orientation);
    for (auto* gains : {&message.position_positive, &message.position_negative, &message.orientation_positive,
                        &message.orientation_negative})
      std::remove_reference_t<decltype(*gains)>::fields(stream, *gains);
  }
};

}  // namespace viscera::nodes::foreign

VISCERA_FOREIGN_MESSAGE(viscera::nodes::foreign::CartesianImpedance, "crtk_msgs/CartesianImpedance",
                        "59675c5b57c990d0b76f7f0c9954d4f3",
                        "std_msgs/Header header\n"
                        "geometry_msgs/Quaternion force_orientation\n"
                        "geometry_msgs/Vector3 force_position\n"
                        "geometry_msgs/Quaternion torque_orientation\n"
                        "crtk_msgs/CartesianImpedanceHalfPlaneGains position_positive\n"
                        "crtk_msgs/CartesianImpedanceHalfPlaneGains position_negative\n"
                        "crtk_msgs/CartesianImpedanceHalfPlaneGains orientation_positive\n"
                        "crtk_msgs/CartesianImpedanceHalfPlaneGains orientation_negative\n"
                        "================================================================================\n"
                        "MSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n"
                        "================================================================================\n"
                        "MSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n"
                        "================================================================================\n"
                        "MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n"
                        "================================================================================\n"
                        "MSG: crtk_msgs/CartesianImpedanceHalfPlaneGains\n"
                        "geometry_msgs/Vector3 p\ngeometry_msgs/Vector3 d\n"
                        "geometry_msgs/Vector3 bias\ngeometry_msgs/Vector3 deadband\n")
