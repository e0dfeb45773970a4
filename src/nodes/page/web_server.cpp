// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/page/web_server.h"

#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <chrono>
#include <mutex>
#include <thread>

#include "nodes/page/web_client.h"
#include "nodes/page/web_rules.h"
#include "nodes/ros/thread_name.h"
#include "viscera/math/error.h"

namespace viscera::nodes {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;
using asio::ip::tcp;
using boost::beast::error_code;

constexpr size_t kMostConnections = 32;  // web sockets and requests at a time
constexpr uint32_t kMostHead = 8192;     // bytes of the head of a request
constexpr std::chrono::seconds kRequestLimit{10};
constexpr std::chrono::milliseconds kAgain{100};  // after a connection that could not be accepted

/// A connection until it has its answer, or is a web socket.
struct Request : std::enable_shared_from_this<Request> {
  Request(tcp::socket&& socket, std::shared_ptr<void> counted) : stream(std::move(socket)), place(std::move(counted)) {
    parser.header_limit(kMostHead);
    parser.body_limit(0);
  }
  boost::beast::tcp_stream stream;
  const std::shared_ptr<void> place;
  boost::beast::flat_buffer in{kMostHead};
  http::request_parser<http::empty_body> parser;
  http::response<http::string_body> response;
};

std::string textOf(boost::beast::string_view text) {
  return {text.data(), text.size()};
}

}  // namespace

struct WebServer::Inside {
  Inside(const WebOptions& chosen, const std::string& html, const Callbacks& callbacks)
      : options(chosen), page(html), acceptor(io), again(io) {
    shared.control = options.control;
    shared.call = callbacks.call;
    shared.refuse = callbacks.refused;
    shared.changed = [this] { clients = shared.clients.size(); };
  }

  void listen();
  void accept();
  void take(tcp::socket&& socket);
  void answer(const std::shared_ptr<Request>& request);
  void send(const std::shared_ptr<Request>& request, http::status status, const std::string& text, bool is_page);
  void refuse(const std::shared_ptr<Request>& request, http::status status, const std::string& why);
  void run();

  const WebOptions options;
  const std::string page;
  std::atomic<size_t> clients{0}, connections{0};
  std::atomic<uint64_t> clients_so_far{0};
  mutable std::mutex mutex;
  std::string failure;  ///< why the thread has ended
  WebShared shared;
  asio::io_context io{1};  ///< after what its operations use
  tcp::acceptor acceptor;
  asio::steady_timer again;
  std::thread thread;
};

void WebServer::Inside::listen() {
  error_code error;
  const asio::ip::address address = asio::ip::make_address(options.address, error);
  if (error) throw Error("parameter ~address: '" + options.address + "' is no IP address, as 127.0.0.1 is");
  const tcp::endpoint place(address, options.port);
  acceptor.open(place.protocol(), error);
  if (!error) acceptor.set_option(asio::socket_base::reuse_address(true), error);
  if (!error) acceptor.bind(place, error);
  if (!error) acceptor.listen(static_cast<int>(kMostConnections), error);
  if (error)
    throw Error("cannot listen at " + options.address + " port " + std::to_string(options.port) + ": " +
                error.message() + "; choose ~address and ~port");
}

void WebServer::Inside::accept() {
  acceptor.async_accept([this](const error_code& error, tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (!error) {
      take(std::move(socket));
      return accept();
    }
    again.expires_after(kAgain);
    again.async_wait([this](const error_code& ended) {
      if (!ended) accept();
    });
  });
}

void WebServer::Inside::take(tcp::socket&& socket) {
  if (connections >= kMostConnections) return shared.refuse("a connection beyond " + std::to_string(kMostConnections));
  ++connections;
  error_code ignored;
  socket.set_option(tcp::no_delay(true), ignored);
  const std::shared_ptr<void> place(nullptr, [this](void*) { --connections; });
  const auto request = std::make_shared<Request>(std::move(socket), place);
  request->stream.expires_after(kRequestLimit);
  http::async_read(request->stream, request->in, request->parser, [this, request](const error_code& failed, size_t) {
    if (!failed) return answer(request);
    const bool gone = failed == http::error::end_of_stream || failed == boost::beast::error::timeout ||
                      failed == asio::error::connection_reset || failed == http::error::partial_message;
    if (!gone) refuse(request, http::status::bad_request, "a request that is not HTTP: " + failed.message());
  });
}

void WebServer::Inside::answer(const std::shared_ptr<Request>& request) {
  const auto& head = request->parser.get();
  const std::string host = textOf(head[http::field::host]), origin = textOf(head[http::field::origin]);
  const std::string target = textOf(head.target());
  if (head.count(http::field::host) != 1 || !isHostAllowed(host))
    return refuse(request, http::status::forbidden, "a request to a host that is neither localhost nor an address");
  if (target == "/live" && boost::beast::websocket::is_upgrade(head)) {
    if (head.count(http::field::origin) > 1 || !isOriginAllowed(origin, host))
      return refuse(request, http::status::forbidden, "a web socket of a page of another origin");
    if (shared.clients.size() >= options.most_clients)
      return refuse(request, http::status::service_unavailable,
                    "more than " + std::to_string(options.most_clients) + " pages (~max_clients)");
    ++clients_so_far;
    std::make_shared<WebClient>(std::move(request->stream), shared, request->place)->accept(head);
    return;
  }
  if (head.method() != http::verb::get)
    return refuse(request, http::status::method_not_allowed, "a request of another method than GET");
  if (target != "/") return refuse(request, http::status::not_found, "a request of another path than /");
  send(request, http::status::ok, page, true);
}

void WebServer::Inside::refuse(const std::shared_ptr<Request>& request, http::status status, const std::string& why) {
  shared.refuse(why);
  send(request, status, "refused: " + why + "\n", false);
}

/// Answers and closes the connection.
void WebServer::Inside::send(const std::shared_ptr<Request>& request, http::status status, const std::string& text,
                             bool is_page) {
  constexpr unsigned kHttp11 = 11;
  http::response<http::string_body>& response = request->response;
  response.version(kHttp11);
  response.result(status);
  response.keep_alive(false);
  response.set(http::field::content_type, is_page ? "text/html; charset=utf-8" : "text/plain; charset=utf-8");
  response.set(http::field::cache_control, "no-store");
  response.set("Content-Security-Policy", "frame-ancestors 'none'");  // the page has one more
  response.set("X-Content-Type-Options", "nosniff");
  response.set("Referrer-Policy", "no-referrer");
  response.set("Cross-Origin-Resource-Policy", "same-origin");
  response.body() = text;
  response.prepare_payload();
  http::async_write(request->stream, response, [request](const error_code&, size_t) {
    error_code ignored;
    request->stream.socket().shutdown(tcp::socket::shutdown_send, ignored);
  });
}

void WebServer::Inside::run() {
  nameThread("page_web");
  try {
    io.run();
  } catch (const std::exception& e) {
    const std::lock_guard<std::mutex> lock(mutex);
    failure = e.what();
  }
}

WebServer::WebServer(const WebOptions& options, const std::string& page, const Callbacks& callbacks)
    : inside_(std::make_unique<Inside>(options, page, callbacks)) {
  inside_->listen();
  inside_->accept();
  inside_->thread = std::thread([this] { inside_->run(); });
}

WebServer::~WebServer() {
  inside_->io.stop();
  inside_->thread.join();
}

uint16_t WebServer::port() const {
  return inside_->acceptor.local_endpoint().port();
}

size_t WebServer::clients() const {
  return inside_->clients;
}

uint64_t WebServer::clientsSoFar() const {
  return inside_->clients_so_far;
}

void WebServer::show(const std::shared_ptr<const LiveFrame>& frame) {
  asio::post(inside_->io, [in = inside_.get(), frame] {
    in->shared.frame = frame;
    for (WebClient* const client : in->shared.clients) client->show(frame);
  });
}

void WebServer::setState(const std::string& text) {
  asio::post(inside_->io, [in = inside_.get(), state = std::make_shared<const std::string>(text)] {
    in->shared.state = state;
    for (WebClient* const client : in->shared.clients) client->setState(state);
  });
}

void WebServer::tell(const std::string& text) {
  asio::post(inside_->io, [in = inside_.get(), told = std::make_shared<const std::string>(text)] {
    for (WebClient* const client : in->shared.clients) client->tell(told);
  });
}

void WebServer::require() const {
  const std::lock_guard<std::mutex> lock(inside_->mutex);
  if (!inside_->failure.empty()) throw Error("the web server has ended: " + inside_->failure);
}

}  // namespace viscera::nodes
