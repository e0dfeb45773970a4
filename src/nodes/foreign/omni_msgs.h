// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <geometry_msgs/Vector3.h>

#include <vector>

#include "nodes/foreign/foreign_message.h"

namespace viscera::nodes::foreign {

/// omni_msgs/OmniFeedback: force [N]; position [mm], to which a driver that is locked pulls.
struct OmniFeedback {
  geometry_msgs::Vector3 force, position;
  template <class Stream, class Message>
  static void fields(Stream& stream, Message& message) {
    stream.next(message.force);
    stream.next(message.position);
  }
};

/// omni_msgs/OmniButtonEvent: 1 pressed, 0 released.
struct OmniButtonEvent {
  int32_t grey_button = 0, white_button = 0;
  template <class Stream, class Message>
  static void fields(Stream& stream, Message& message) {
    stream.next(message.grey_button);
    stream.next(message.white_button);
  }
};

}  // namespace viscera::nodes::foreign

VISCERA_FOREIGN_MESSAGE(viscera::nodes::foreign::OmniFeedback, "omni_msgs/OmniFeedback",
                        "e9083ac4fd95494e94fbb0c0f90b6c00",
                        "geometry_msgs/Vector3 force\n"
                        "geometry_msgs/Vector3 position\n"
                        "================================================================================\n"
                        "MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n")
VISCERA_FOREIGN_MESSAGE(viscera::nodes::foreign::OmniButtonEvent, "omni_msgs/OmniButtonEvent",
                        "fb77877e6b639935c3360838062f05f0", "int32 grey_button\nint32 white_button\n")
