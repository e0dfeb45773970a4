// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/master_watch.h"

#include <netdb.h>
#include <poll.h>
#include <ros/master.h>
#include <ros/this_node.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <cerrno>
#include <string>

namespace viscera::nodes {
namespace {

constexpr std::chrono::seconds kPeriod{1};
constexpr std::chrono::seconds kPatience{5};  ///< a busy master may miss a question or two
constexpr timeval kConnectLimit{1, 0};

bool masterKnowsThisNode() {
  XmlRpc::XmlRpcValue request, response, uri;
  request[0] = ros::this_node::getName();
  request[1] = ros::this_node::getName();
  return ros::master::execute("lookupNode", request, response, uri, false);
}

}  // namespace

void MasterLine::close() {
  if (socket_ >= 0) ::close(socket_);
  socket_ = -1;
}

bool MasterLine::open() {
  close();
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const std::string port = std::to_string(ros::master::getPort());
  if (getaddrinfo(ros::master::getHost().c_str(), port.c_str(), &hints, &found) != 0) return false;
  for (const addrinfo* at = found; at && socket_ < 0; at = at->ai_next) {
    socket_ = socket(at->ai_family, at->ai_socktype | SOCK_CLOEXEC, at->ai_protocol);
    if (socket_ < 0) continue;
    setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &kConnectLimit, sizeof kConnectLimit);
    if (connect(socket_, at->ai_addr, at->ai_addrlen) != 0) close();
  }
  freeaddrinfo(found);
  return socket_ >= 0;
}

bool MasterLine::broken() {
  if (socket_ < 0) return false;
  pollfd at{socket_, POLLIN, 0};
  if (poll(&at, 1, 0) <= 0) return false;
  char said;
  const ssize_t got = recv(socket_, &said, 1, MSG_DONTWAIT);
  return got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR);
}

bool MasterWatch::check() {
  const Clock::time_point now = Clock::now();
  if (line_.broken()) return line_.open() && masterKnowsThisNode();
  if (now - asked_ < kPeriod) return true;
  asked_ = now;
  if (masterKnowsThisNode()) known_ = now;
  return now - known_ < kPatience;
}

}  // namespace viscera::nodes
