// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "devices/steered_hand.h"

namespace viscera::rviz_plugin {

/// What the mouse wants of a stylus.
struct WantedStylus {
  std::string topics;  ///< what measured_cp, button1 and button2 are behind, with its slash; empty: no stylus
  std::string frame;   ///< of the pose
  Pose tip;
  std::array<bool, 2> buttons{};
  double speed_m_per_s = 0.1;  ///< of the tip, at most: a mouse jumps
};

/// Publishes a stylus as CRTK devices do, at a steady rate on a thread of its own, as a window may be slow to draw.
class StylusSender {
 public:
  StylusSender();
  ~StylusSender();
  /// To be told again and again: after kSilence nothing more is sent, so that the simulator lets go.
  void want(const WantedStylus& wanted);
  /// Buttons are let go, and nothing more is sent.
  void rest();

 private:
  struct Topics;
  void main();

  std::mutex mutex_;
  std::condition_variable changed_;
  WantedStylus wanted_;
  std::chrono::steady_clock::time_point told_{};
  bool ending_ = false;
  std::thread thread_;  ///< last: it uses all of the above
};

}  // namespace viscera::rviz_plugin
