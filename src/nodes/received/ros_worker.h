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

namespace viscera::received {

/// Runs jobs that wait for a master or a simulator, one after another on a thread of its own. An answer may take a
/// minute, and a window that waits for it would freeze.
class RosWorker {
 public:
  /// The callback gets texts for the user, on that thread: that a call waits, and its result.
  explicit RosWorker(std::function<void(const std::string&)> report);
  /// Ends without waiting for answers.
  ~RosWorker();

  /// Calls a service. @param service  full name of a service with success and message in its response
  template <class Service>
  void call(const std::string& service, const typename Service::Request& request) {
    add([this, service, request] { return ask<Service>(service, request).text; });
  }
  struct Answer {
    bool success = false;
    std::string text;  ///< text for the user
  };
  /// Calls a service and waits for its answer. Call it within a job.
  template <class Service>
  Answer ask(const std::string& service, const typename Service::Request& request) {
    report_(service + " ...");
    ros::ServiceClient client = hold<Service>(service);
    typename Service::Response response;
    if (!client.isValid()) return {false, "no service " + service};
    if (!client.call(request, response)) return {false, service + ": no answer"};
    if (!response.success) return {false, service + ": refused: " + response.message};
    return {true, service + ": " + (response.message.empty() ? "done" : response.message)};
  }
  /// Adds a job. @param job  @returns a text for the user; empty: none
  void add(std::function<std::string()> job);

 private:
  void main();
  /// Returns a client that the destructor shuts down, which ends a waiting call.
  template <class Service>
  ros::ServiceClient hold(const std::string& service) {
    ros::ServiceClient client = ros::NodeHandle().serviceClient<Service>(service, true);
    const std::lock_guard<std::mutex> lock(mutex_);
    client_ = client;
    return client;
  }

  const std::function<void(const std::string&)> report_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<std::string()>> jobs_;
  ros::ServiceClient client_;
  bool ending_ = false, ended_ = false;
  std::thread thread_;  ///< last member: it uses all of the above
};

}  // namespace viscera::received
