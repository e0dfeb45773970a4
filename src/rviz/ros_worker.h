// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <ros/node_handle.h>
#include <ros/service_client.h>

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace viscera::rviz_plugin {

/// Does, one after the other on a thread of its own, what waits for a master or a simulator: an answer may take a
/// minute, and a window that waits for it is dead.
class RosWorker {
 public:
  /// @param told  called on that thread with what a person is told: that a call waits, and what has come of it
  explicit RosWorker(std::function<void(const std::string&)> told);
  /// Does not wait for answers.
  ~RosWorker();

  /// @param service  whole name, of a Service whose response has success and message
  template <class Service>
  void call(const std::string& service, const typename Service::Request& request) {
    add([this, service, request] { return ask<Service>(service, request).text; });
  }
  struct Answer {
    bool success = false;
    std::string text;  ///< what a person is told
  };
  /// Calls a service and waits for its answer; within a job.
  template <class Service>
  Answer ask(const std::string& service, const typename Service::Request& request) {
    told_(service + " ...");
    ros::ServiceClient client = hold<Service>(service);
    typename Service::Response response;
    if (!client.isValid()) return {false, "no service " + service};
    if (!client.call(request, response)) return {false, service + ": no answer"};
    if (!response.success) return {false, service + ": refused: " + response.message};
    return {true, service + ": " + (response.message.empty() ? "done" : response.message)};
  }
  /// @param job  @returns what a person is told; empty: nothing
  void add(std::function<std::string()> job);

 private:
  void main();
  /// One that the end closes, which ends a call that waits.
  template <class Service>
  ros::ServiceClient hold(const std::string& service) {
    ros::ServiceClient client = ros::NodeHandle().serviceClient<Service>(service, true);
    const std::lock_guard<std::mutex> lock(mutex_);
    client_ = client;
    return client;
  }

  const std::function<void(const std::string&)> told_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<std::string()>> jobs_;
  ros::ServiceClient client_;
  bool ending_ = false, ended_ = false;
  std::thread thread_;  ///< last: it uses all of the above
};

}  // namespace viscera::rviz_plugin
