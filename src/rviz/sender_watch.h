// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <set>
#include <string>
#include <thread>

namespace viscera::rviz_plugin {

/// Returns whether something listens at an address.
/// @param uri  as in http://host:port/   @param limit  how long an answer is waited for
bool listens(const std::string& uri, std::chrono::milliseconds limit);

/// The nodes that send a topic, as the master knows them, and which of them still run: the master keeps a node that was
/// killed, and roscpp counts it as a publisher. A thread of its own looks twice a second.
class SenderWatch {
 public:
  struct Senders {
    std::set<std::string> uris;   ///< of the nodes
    std::set<std::string> alive;  ///< those that answer
    bool known = false;           ///< the master answered since the topic was chosen
  };

  SenderWatch();
  ~SenderWatch();
  SenderWatch(const SenderWatch&) = delete;
  SenderWatch& operator=(const SenderWatch&) = delete;

  /// @param topic  whole name; empty: none
  void follow(const std::string& topic);
  Senders senders() const;

 private:
  void main();

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::string topic_;
  Senders senders_;
  bool anew_ = false;  ///< the topic was chosen and not looked at yet
  bool ending_ = false;
  std::thread thread_;  ///< last: it uses all of the above
};

}  // namespace viscera::rviz_plugin
