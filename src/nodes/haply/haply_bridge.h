// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <geometry_msgs/WrenchStamped.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <std_msgs/Bool.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "nodes/haply/inverse_message.h"
#include "nodes/haply/inverse_socket.h"
#include "nodes/ros/end_watch.h"
#include "nodes/ros/parameters.h"

namespace viscera::nodes {

struct HaplyOptions {
  std::string name = "inverse3";  ///< prefix of the topics
  std::string device = "any", grip = "any";
  InverseSocket::Options service;
  double timeout_s = 0.05;  ///< age of a wrench above which the device gets no force
  double max_force_n = 4;
};
/// Reads the private parameters. @throws ParameterError
HaplyOptions haplyOptions(Parameters& parameters);

/// Connects a Haply Inverse3 and its grip, by the Haply Inverse Service, to the topics of a CRTK device. The device
/// gets no force without a fresh wrench, when the process ends, and while it is stopped.
class HaplyBridge {
 public:
  /// @param end  must outlive this object
  HaplyBridge(const HaplyOptions& options, EndWatch& end);
  ~HaplyBridge();
  HaplyBridge(const HaplyBridge&) = delete;
  HaplyBridge& operator=(const HaplyBridge&) = delete;
  /// Runs until the end begins. @throws MasterLost
  void run();

 private:
  using Clock = std::chrono::steady_clock;

  // On the socket's thread.
  std::string take(const std::string& message, bool first);
  void choose(const std::string& inventory);
  void tell(const std::string& event);
  std::string command();
  void lose(const std::string& why);
  void publish(const InverseState& state);

  void onWrench(const geometry_msgs::WrenchStamped& message);
  void release();
  void log();
  void report(diagnostic_updater::DiagnosticStatusWrapper& status);

  const HaplyOptions options_;
  EndWatch& end_;
  ros::NodeHandle node_;
  ros::Publisher poses_, velocities_, buttons_;
  InverseDevices devices_;  ///< of the socket's thread, as the next two
  bool first_command_ = true;
  std::array<bool, 3> sent_buttons_{};

  std::mutex mutex_;  ///< guards all up to the next blank line
  Vector3d force_n_ = Vector3d::Zero();
  bool is_absolute_ = false;  ///< whether wrenches are in the frame of the poses, not in that of the grip
  Quaterniond grip_ = Quaterniond::Identity();
  Clock::time_point heard_{};  ///< arrival of the newest wrench
  Clock::time_point posed_{};  ///< of the newest pose, or begin of the connection
  bool connected_ = false, calibrated_ = true;
  std::string state_;  ///< devices, or why there is no connection
  std::string last_dropped_;
  struct Note {
    std::string text;
    bool is_warning;
  };
  std::vector<Note> notes_;

  std::atomic<uint64_t> states_{0}, dropped_{0}, connections_{0};
  std::atomic<uint64_t> zeros_{0};     ///< commands without force that were sent
  std::atomic<bool> released_{false};  ///< whether the end has begun, or the process is about to be stopped
  uint64_t logged_dropped_ = 0, reported_states_ = 0;
  Clock::time_point log_due_{}, report_due_{}, reported_{};
  ros::Subscriber wrench_, absolute_;
  diagnostic_updater::Updater updater_;
  std::unique_ptr<InverseSocket> socket_;  ///< last members: they use all of the above
  EndWatch::Act act_;
  ros::AsyncSpinner spinner_;
};

}  // namespace viscera::nodes
