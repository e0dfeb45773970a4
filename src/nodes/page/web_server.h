// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "nodes/page/live_message.h"

namespace viscera::nodes {

struct WebOptions {
  std::string address = "127.0.0.1";  ///< IP address to listen at
  uint16_t port = 8765;               ///< 0: any free port
  size_t most_clients = 4;            ///< web sockets at a time
  bool control = false;               ///< whether clients may call services
};

/// Serves one page by HTTP, and frames to it by a web socket at /live, on a thread of its own. Other requests, pages of
/// other origins (web_rules.h) and messages that are not the viewer's end the connection. Thread-safe.
class WebServer {
 public:
  /// Called on the server's thread.
  struct Callbacks {
    std::function<void(const std::string& service, const std::string& task)> call;
    std::function<void(const std::string& why)> refused;  ///< a request or message was refused
  };
  /// Begins to listen. @param page  HTML   @throws Error  it cannot listen there
  WebServer(const WebOptions& options, const std::string& page, const Callbacks& callbacks);
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  uint16_t port() const;
  size_t clients() const;         ///< open web sockets
  uint64_t clientsSoFar() const;  ///< web sockets that were opened
  /// Sends a frame to every client that is ready for it; it replaces one that was not sent. @param frame  null: none
  void show(const std::shared_ptr<const LiveFrame>& frame);
  void setState(const std::string& text);  ///< sends the state to all clients, and to each new one
  void tell(const std::string& text);      ///< sends a message to all clients
  /// @throws Error  the server's thread has ended
  void require() const;

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace viscera::nodes
