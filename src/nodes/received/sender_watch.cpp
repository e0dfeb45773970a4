// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/received/sender_watch.h"

#include <netdb.h>
#include <poll.h>
#include <ros/master.h>
#include <ros/network.h>
#include <ros/this_node.h>
#include <sys/socket.h>
#include <unistd.h>
#include <xmlrpcpp/XmlRpcException.h>

#include <cerrno>
#include <memory>
#include <optional>
#include <utility>

namespace viscera::received {
namespace {

constexpr std::chrono::milliseconds kCheckEvery{500};
constexpr std::chrono::milliseconds kAnswerLimit{300};

/// Queries the master. @returns whether it answered
bool ask(const char* method, const std::string& argument, XmlRpc::XmlRpcValue& answer) {
  XmlRpc::XmlRpcValue request, response;
  request[0] = ros::this_node::getName();
  if (!argument.empty()) request[1] = argument;
  return ros::master::execute(method, request, response, answer, false);
}

/// Returns the addresses of the nodes that publish a topic; nothing if the master does not answer.
std::optional<std::set<std::string>> sendersOf(const std::string& topic) try {
  std::set<std::string> uris;
  XmlRpc::XmlRpcValue state, uri;
  if (!ask("getSystemState", "", state)) return std::nullopt;
  XmlRpc::XmlRpcValue& published = state[0];
  for (int i = 0; i < published.size(); ++i) {
    if (static_cast<std::string&>(published[i][0]) != topic) continue;
    XmlRpc::XmlRpcValue& nodes = published[i][1];
    for (int n = 0; n < nodes.size(); ++n)
      if (ask("lookupNode", nodes[n], uri)) uris.insert(static_cast<std::string&>(uri));
  }
  return uris;
} catch (const XmlRpc::XmlRpcException&) {  // an answer of another form is not a master's
  return std::nullopt;
}

bool connects(const addrinfo& address, std::chrono::milliseconds limit) {
  const int file = socket(address.ai_family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (file < 0) return false;
  bool there = connect(file, address.ai_addr, address.ai_addrlen) == 0;
  pollfd waited{file, POLLOUT, 0};
  if (!there && errno == EINPROGRESS && poll(&waited, 1, static_cast<int>(limit.count())) == 1) {
    int error = 0;
    socklen_t size = sizeof error;
    there = getsockopt(file, SOL_SOCKET, SO_ERROR, &error, &size) == 0 && error == 0;
  }
  close(file);
  return there;
}

}  // namespace

bool listens(const std::string& uri, std::chrono::milliseconds limit) {
  std::string host;
  uint32_t port = 0;
  if (!ros::network::splitURI(uri, host, port)) return false;
  addrinfo wanted{};
  wanted.ai_family = AF_UNSPEC;
  wanted.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (getaddrinfo(host.c_str(), std::to_string(port).c_str(), &wanted, &found) != 0) return false;
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> addresses(found, freeaddrinfo);
  for (const addrinfo* address = found; address; address = address->ai_next)
    if (connects(*address, limit)) return true;
  return false;
}

SenderWatch::SenderWatch() : thread_([this] { main(); }) {}

SenderWatch::~SenderWatch() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void SenderWatch::follow(const std::string& topic) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    topic_ = topic;
    senders_ = {};
    anew_ = true;
  }
  changed_.notify_all();
}

SenderWatch::Senders SenderWatch::senders() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return senders_;
}

void SenderWatch::main() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!ending_) {
    anew_ = false;
    const std::string topic = topic_;
    lock.unlock();
    Senders seen;
    if (const auto uris = topic.empty() ? std::nullopt : sendersOf(topic)) {
      seen.known = true;
      seen.uris = *uris;
      for (const std::string& uri : *uris)
        if (listens(uri, kAnswerLimit)) seen.alive.insert(uri);
    }
    lock.lock();
    if (!anew_) senders_ = std::move(seen);
    changed_.wait_for(lock, kCheckEvery, [this] { return ending_ || anew_; });
  }
}

}  // namespace viscera::received
