// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/page/web_client.h"

#include <algorithm>
#include <boost/asio/buffer.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/websocket/error.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <chrono>
#include <utility>

#include "nodes/page/web_rules.h"

namespace viscera::nodes {
namespace {

namespace websocket = boost::beast::websocket;
using boost::beast::error_code;

constexpr std::chrono::seconds kHandshake{10}, kIdle{30};  // pings in between keep a connection
constexpr size_t kMostTold = 8;

/// Returns whether a client has broken the protocol, in contrast to having gone.
bool isBreach(const error_code& error) {
  return error == websocket::error::buffer_overflow || error == websocket::error::message_too_big ||
         error == websocket::condition::protocol_violation;
}

}  // namespace

WebClient::WebClient(boost::beast::tcp_stream&& stream, WebShared& shared, std::shared_ptr<void> place)
    : stream_(std::move(stream)), shared_(shared), place_(std::move(place)) {
  shared_.clients.insert(this);
  shared_.changed();
}

WebClient::~WebClient() {
  shared_.clients.erase(this);
  shared_.changed();
}

void WebClient::accept(const Request& request) {
  stream_.next_layer().expires_never();  // the web socket has times of its own
  stream_.set_option(websocket::stream_base::timeout{kHandshake, kIdle, true});
  stream_.read_message_max(kMostBytes);
  stream_.auto_fragment(false);
  stream_.async_accept(request, [self = shared_from_this()](const error_code& error) {
    if (error) return self->shared_.refuse("a web socket that could not be opened: " + error.message());
    self->open_ = true;
    self->state_ = self->shared_.state;
    self->frame_ = self->shared_.frame;
    self->read();
    self->write();
  });
}

void WebClient::read() {
  stream_.async_read(in_, [self = shared_from_this()](const error_code& error, size_t) {
    if (error) {
      self->open_ = false;
      if (isBreach(error)) self->shared_.refuse("a web socket message: " + error.message());
      return;
    }
    const std::string text = boost::beast::buffers_to_string(self->in_.data());
    self->in_.consume(self->in_.size());
    self->take(text, self->stream_.got_text());
  });
}

void WebClient::take(const std::string& text, bool is_text) {
  const std::optional<ClientMessage> message = is_text ? clientMessageOf(text) : std::nullopt;
  if (!message) return refuse("a message that is none of the viewer's");
  if (message->shown) {
    if (std::find(ahead_.begin(), ahead_.end(), *message->shown) == ahead_.end())
      return refuse("a frame shown that was not under way");
    while (ahead_.front() != *message->shown) ahead_.pop_front();
    ahead_.pop_front();
  } else if (!shared_.control) {
    return refuse("call of " + message->service + " although the page is read-only; ~control allows calls");
  } else {
    shared_.call(message->service, message->task);
  }
  read();
  write();
}

/// Closes the connection.
void WebClient::refuse(const std::string& why) {
  open_ = false;
  shared_.refuse(why);
  constexpr size_t kLongest = 100;  // letters of a reason in a close message: 123
  stream_.async_close({websocket::close_code::policy_error, why.substr(0, kLongest)},
                      [self = shared_from_this()](const error_code&) {});
}

void WebClient::show(const std::shared_ptr<const LiveFrame>& frame) {
  frame_ = frame;
  write();
}

void WebClient::setState(const std::shared_ptr<const std::string>& state) {
  state_ = state;
  write();
}

void WebClient::tell(const std::shared_ptr<const std::string>& text) {
  told_.push_back(text);
  if (told_.size() > kMostTold) told_.pop_front();
  write();
}

/// Chooses the messages of the next turn.
void WebClient::collect() {
  if (state_) out_.push_back({std::move(state_), true});
  state_.reset();
  for (; !told_.empty(); told_.pop_front()) out_.push_back({told_.front(), true});
  if (!frame_ || ahead_.size() >= kMostAhead) return;
  std::set<uint32_t> needs;
  for (const std::shared_ptr<const LivePart>& part : frame_->parts) {
    needs.insert(part->number);
    if (parts_.count(part->number) == 0) out_.push_back({{part, &part->bytes}, false});
  }
  parts_ = std::move(needs);
  out_.push_back({{frame_, &frame_->bytes}, false});
  ahead_.push_back(frame_->number);
  frame_.reset();
}

void WebClient::write() {
  if (!open_ || writing_) return;
  if (out_.empty()) collect();
  if (out_.empty()) return;
  writing_ = true;
  const Message message = out_.front();
  out_.pop_front();
  stream_.text(message.text);
  stream_.async_write(boost::asio::buffer(*message.bytes),
                      [self = shared_from_this(), message](const error_code& error, size_t) {
                        self->writing_ = false;
                        if (error)
                          self->open_ = false;
                        else
                          self->write();
                      });
}

}  // namespace viscera::nodes
