// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace viscera::nodes {

/// Web socket to a service that answers each message with one, on a thread of its own. It sends at a steady rate, and
/// connects again a second after the service has gone.
class InverseSocket {
 public:
  struct Options {
    std::string host = "127.0.0.1";
    uint16_t port = 10001;
    std::chrono::duration<double> period{0.001};  ///< time from one message to the next
  };
  /// Called on the socket's thread.
  struct Callbacks {
    /// Takes a message of the service. @param first  of the connection   @return why to connect again; empty: go on
    std::function<std::string(const std::string& message, bool first)> take;
    std::function<std::string()> command;              ///< returns the next message
    std::function<void(const std::string& why)> lost;  ///< there is no connection, or no longer
  };
  InverseSocket(const Options& options, const Callbacks& callbacks);
  ~InverseSocket();
  InverseSocket(const InverseSocket&) = delete;
  InverseSocket& operator=(const InverseSocket&) = delete;

 private:
  struct Inside;
  struct Link;
  std::unique_ptr<Inside> inside_;
};

}  // namespace viscera::nodes
