// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <deque>
#include <functional>
#include <memory>
#include <set>
#include <string>

#include "nodes/page/live_message.h"

namespace viscera::nodes {

/// What clients share. All is used on the server's thread.
struct WebShared {
  bool control = false;
  std::function<void(const std::string& service, const std::string& task)> call;
  std::function<void(const std::string& why)> refuse;  ///< counts a request or message that was refused
  std::set<class WebClient*> clients;
  std::function<void()> changed;  ///< a client has come or gone
  std::shared_ptr<const LiveFrame> frame;
  std::shared_ptr<const std::string> state;
};

/// A browser at a web socket. It gets the newest frame once it has drawn those before: at most kMostAhead are under
/// way, and a frame that a newer one has replaced is never sent. Lives as long as its operations.
class WebClient : public std::enable_shared_from_this<WebClient> {
 public:
  using Stream = boost::beast::websocket::stream<boost::beast::tcp_stream>;
  using Request = boost::beast::http::request<boost::beast::http::empty_body>;

  WebClient(boost::beast::tcp_stream&& stream, WebShared& shared, std::shared_ptr<void> place);
  ~WebClient();
  WebClient(const WebClient&) = delete;
  WebClient& operator=(const WebClient&) = delete;

  /// Answers the request that opens the web socket, and begins.
  void accept(const Request& request);
  void show(const std::shared_ptr<const LiveFrame>& frame);
  void setState(const std::shared_ptr<const std::string>& state);
  void tell(const std::shared_ptr<const std::string>& text);

  static constexpr size_t kMostAhead = 2;
  static constexpr size_t kMostBytes = 4096;  ///< of a message from a browser

 private:
  struct Message {
    std::shared_ptr<const std::string> bytes;
    bool text;
  };
  void read();
  void take(const std::string& text, bool is_text);
  void refuse(const std::string& why);
  void collect();
  void write();

  Stream stream_;
  WebShared& shared_;
  const std::shared_ptr<void> place_;  ///< counted by the server
  boost::beast::flat_buffer in_;
  bool open_ = false, writing_ = false;
  std::deque<Message> out_;                              ///< messages of one turn
  std::deque<std::shared_ptr<const std::string>> told_;  ///< answers for the next turn
  std::shared_ptr<const std::string> state_;             ///< not sent yet
  std::shared_ptr<const LiveFrame> frame_;               ///< not sent yet
  std::set<uint32_t> parts_;                             ///< parts that the browser has
  std::deque<uint32_t> ahead_;                           ///< frames that were sent and not drawn yet
};

}  // namespace viscera::nodes
