// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/haply/inverse_socket.h"

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <thread>
#include <utility>

#include "nodes/ros/thread_name.h"

namespace viscera::nodes {
namespace {

namespace asio = boost::asio;
namespace websocket = boost::beast::websocket;
using asio::ip::tcp;
using boost::beast::error_code;
using InverseClock = std::chrono::steady_clock;

constexpr size_t kMostMessage = 1 << 20;                  // bytes; an inventory of several devices has some thousand
constexpr std::chrono::seconds kConnect{2}, kSilence{1};  // limits of a connection, and of a message's answer
constexpr std::chrono::seconds kInverseAgain{1};

}  // namespace

struct InverseSocket::Inside {
  Inside(const Options& chosen, const Callbacks& called)
      : options(chosen),
        callbacks(called),
        period(std::chrono::duration_cast<InverseClock::duration>(chosen.period)),
        resolver(io),
        again(io) {}
  void connect();
  void lose(const std::string& why);

  const Options options;
  const Callbacks callbacks;
  const InverseClock::duration period;
  asio::io_context io{1};
  tcp::resolver resolver;
  asio::steady_timer again;
  std::thread thread;
};

/// One connection. Lives as long as its operations.
struct InverseSocket::Link : std::enable_shared_from_this<Link> {
  explicit Link(Inside& owner) : inside(owner), stream(owner.io), timer(owner.io) {}

  void begin(const tcp::resolver::results_type& places);
  void read();
  void take();
  void write();
  /// Ends the connection, once. @returns whether there was an error
  bool failed(const error_code& error, const std::string& where);

  Inside& inside;
  websocket::stream<boost::beast::tcp_stream> stream;
  asio::steady_timer timer;
  boost::beast::flat_buffer in;
  std::string out;
  bool first = true;
  InverseClock::time_point due{};
};

bool InverseSocket::Link::failed(const error_code& error, const std::string& where) {
  if (error) inside.lose(where + error.message());
  return static_cast<bool>(error);
}

void InverseSocket::Link::begin(const tcp::resolver::results_type& places) {
  auto& layer = stream.next_layer();
  layer.expires_after(kConnect);
  layer.async_connect(places, [self = shared_from_this()](const error_code& error, const tcp::endpoint&) {
    if (self->failed(error, "")) return;
    auto& connected = self->stream.next_layer();
    connected.expires_never();  // the web socket has times of its own
    error_code ignored;
    connected.socket().set_option(tcp::no_delay(true), ignored);
    self->stream.set_option(websocket::stream_base::timeout{kConnect, kSilence, false});
    self->stream.read_message_max(kMostMessage);
    self->stream.text(true);
    const Options& options = self->inside.options;
    self->stream.async_handshake(options.host + ":" + std::to_string(options.port), "/",
                                 [self](const error_code& refused) {
                                   if (!self->failed(refused, "no web socket: ")) self->read();
                                 });
  });
}

void InverseSocket::Link::read() {
  stream.async_read(in, [self = shared_from_this()](const error_code& error, size_t) {
    if (!self->failed(error, "")) self->take();
  });
}

void InverseSocket::Link::take() {
  const std::string text = boost::beast::buffers_to_string(in.data());
  in.consume(in.size());
  const std::string why = inside.callbacks.take(text, std::exchange(first, false));
  if (!why.empty()) return inside.lose(why);
  due = std::max(due + inside.period, InverseClock::now());
  timer.expires_at(due);
  timer.async_wait([self = shared_from_this()](const error_code& ended) {
    if (!ended) self->write();
  });
}

void InverseSocket::Link::write() {
  out = inside.callbacks.command();
  stream.async_write(asio::buffer(out), [self = shared_from_this()](const error_code& error, size_t) {
    if (!self->failed(error, "")) self->read();
  });
}

void InverseSocket::Inside::connect() {
  resolver.async_resolve(options.host, std::to_string(options.port),
                         [this](const error_code& error, const tcp::resolver::results_type& places) {
                           if (error) return lose(error.message());
                           std::make_shared<Link>(*this)->begin(places);
                         });
}

void InverseSocket::Inside::lose(const std::string& why) {
  callbacks.lost(why);
  again.expires_after(kInverseAgain);
  again.async_wait([this](const error_code& ended) {
    if (!ended) connect();
  });
}

InverseSocket::InverseSocket(const Options& options, const Callbacks& callbacks)
    : inside_(std::make_unique<Inside>(options, callbacks)) {
  inside_->connect();
  inside_->thread = std::thread([this] {
    nameThread("haply");
    inside_->io.run();
  });
}

InverseSocket::~InverseSocket() {
  inside_->io.stop();
  inside_->thread.join();
}

}  // namespace viscera::nodes
