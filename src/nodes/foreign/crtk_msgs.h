// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <std_msgs/Header.h>

#include <string>

#include "nodes/foreign/foreign_message.h"

namespace viscera::nodes::foreign {

/// crtk_msgs/OperatingState: DISABLED, ENABLED, PAUSED or FAULT; busy while it moves to a goal.
struct OperatingState {
  std_msgs::Header header;
  std::string state;
  uint8_t is_homed = 0, is_busy = 0;
  template <class Stream, class Message>
  static void fields(Stream& stream, Message& message) {
    stream.next(message.header);
    stream.next(message.state);
    stream.next(message.is_homed);
    stream.next(message.is_busy);
  }
};

/// crtk_msgs/StringStamped.
struct StringStamped {
  std_msgs::Header header;
  std::string string;
  template <class Stream, class Message>
  static void fields(Stream& stream, Message& message) {
    stream.next(message.header);
    stream.next(message.string);
  }
};

}  // namespace viscera::nodes::foreign

VISCERA_FOREIGN_MESSAGE(viscera::nodes::foreign::OperatingState, "crtk_msgs/OperatingState",
                        "b1bd4021639d9d9c5fbfff78d6ff3158",
                        "std_msgs/Header header\nstring state\nbool is_homed\nbool is_busy\n"
                        "================================================================================\n"
                        "MSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n")
VISCERA_FOREIGN_MESSAGE(viscera::nodes::foreign::StringStamped, "crtk_msgs/StringStamped",
                        "5e3e46086181199270f1ac3a28a5977f",
                        "std_msgs/Header header\nstring string\n"
                        "================================================================================\n"
                        "MSG: std_msgs/Header\nuint32 seq\ntime stamp\nstring frame_id\n")
