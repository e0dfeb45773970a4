// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <geometry_msgs/Vector3.h>

#include <vector>

#include "nodes/foreign/foreign_message.h"

namespace viscera::nodes::foreign {

/// geomagic_control/DeviceFeedback: force [N]; position [mm], and along which axes to hold it there. Its older name,
/// OmniFeedback, has the same sum.
struct GeomagicFeedback {
  geometry_msgs::Vector3 force, position;
  std::vector<uint8_t> lock = {0, 0, 0};
  template <class Stream, class Message>
  static void fields(Stream& stream, Message& message) {
    stream.next(message.force);
    stream.next(message.position);
    stream.next(message.lock);
  }
};

}  // namespace viscera::nodes::foreign

VISCERA_FOREIGN_MESSAGE(viscera::nodes::foreign::GeomagicFeedback, "geomagic_control/DeviceFeedback",
                        "94755b031db27fe99c2c235c0da9b072",
                        "geometry_msgs/Vector3 force\n"
                        "geometry_msgs/Vector3 position\n"
                        "bool[] lock\n"
                        "================================================================================\n"
                        "MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n")
