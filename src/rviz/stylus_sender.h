// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "devices/steered_tool.h"

namespace viscera::rviz_plugin {

/// Desired state of a stylus that the mouse moves.
struct WantedStylus {
  std::string topics;  ///< prefix of measured_cp, button1 and button2, with its slash; empty: no stylus
  std::string frame;   ///< frame of the pose
  Pose tip;
  std::array<bool, 2> buttons{};
  double speed_m_per_s = 0.1;  ///< largest speed of the tip [m/s]: a mouse jumps
};

/// Publishes a stylus as CRTK devices do, at a steady rate on a thread of its own, since a window may be slow to draw.
class StylusSender {
 public:
  StylusSender();
  ~StylusSender();
  /// Sets the desired state. Call it repeatedly: after kSilence without a call nothing is sent, so that the simulator
  /// stops tracking.
  void request(const WantedStylus& wanted);
  /// Releases the buttons and stops sending.
  void rest();

 private:
  struct Topics;
  void main();

  std::mutex mutex_;
  std::condition_variable changed_;
  WantedStylus wanted_;
  std::chrono::steady_clock::time_point sent_at_{};
  bool ending_ = false;
  std::thread thread_;  ///< last member: it uses all of the above
};

}  // namespace viscera::rviz_plugin
