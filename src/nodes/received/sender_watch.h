// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <set>
#include <string>
#include <thread>

namespace viscera::received {

/// Returns whether a server accepts connections at an address.
/// @param uri  as in http://host:port/   @param limit  timeout
bool listens(const std::string& uri, std::chrono::milliseconds limit);

/// The nodes that publish a topic, as the master knows them, and which of them are alive: the master keeps a node that
/// was killed, and roscpp counts it as a publisher. A separate thread checks twice a second.
class SenderWatch {
 public:
  struct Senders {
    std::set<std::string> uris;   ///< addresses of the nodes
    std::set<std::string> alive;  ///< addresses that accept connections
    bool known = false;           ///< whether the master has answered since the topic was chosen
  };

  SenderWatch();
  ~SenderWatch();
  SenderWatch(const SenderWatch&) = delete;
  SenderWatch& operator=(const SenderWatch&) = delete;

  /// Chooses the topic. @param topic  full name; empty: none
  void follow(const std::string& topic);
  Senders senders() const;

 private:
  void main();

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::string topic_;
  Senders senders_;
  bool anew_ = false;  ///< whether the topic was chosen and not checked yet
  bool ending_ = false;
  std::thread thread_;  ///< last member: it uses all of the above
};

}  // namespace viscera::received
