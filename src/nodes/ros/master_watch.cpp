// Copyright (c) 2026, the viscera authors
// SPDX-License-Identifier: BSD-3-Clause
#include "nodes/ros/master_watch.h"

#include <netdb.h>
#include <poll.h>
#include <ros/console.h>
#include <ros/master.h>
#include <ros/this_node.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <mutex>
#include <string>

#include "nodes/ros/end_watch.h"
#include "nodes/ros/thread_name.h"

namespace viscera::nodes {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::chrono::seconds kPeriod{1};             ///< period of queries
constexpr std::chrono::milliseconds kPoll{20};         ///< time until the end of this object is noticed
constexpr std::chrono::seconds kPatience{5};           ///< a busy master may miss a query or two
constexpr std::chrono::milliseconds kLastAnswer{100};  ///< patience for the answer of a working master
constexpr std::chrono::seconds kUnnoticed{5};          ///< loss that was not checked: main() may wait without limit
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

bool MasterLine::broken(std::chrono::milliseconds limit) {
  pollfd at{socket_, POLLIN, 0};
  if (poll(&at, socket_ < 0 ? 0 : 1, static_cast<int>(limit.count())) <= 0) return false;
  char said;
  const ssize_t got = recv(socket_, &said, 1, MSG_DONTWAIT);
  return got == 0 || (got < 0 && errno != EAGAIN && errno != EINTR);
}

MasterLost::MasterLost()
    : Error("the ROS master is lost, or was restarted and does not know this node; restart the node") {
  EndWatch::begin(EXIT_FAILURE);
  ROS_FATAL("%s", what());  // logged now: a master that hangs would block it after topics are unregistered
}

struct MasterWatch::Shared {
  std::mutex mutex;
  std::condition_variable changed;
  bool stop = false, ended = false;
  bool lost = false;
  Clock::time_point known = Clock::now();  ///< time at which the master last knew this node
};

MasterWatch::MasterWatch() : shared_(std::make_shared<Shared>()), thread_([shared = shared_] { ask(shared); }) {}

MasterWatch::~MasterWatch() {
  std::unique_lock<std::mutex> lock(shared_->mutex);
  shared_->stop = true;
  shared_->changed.notify_all();
  const bool ended = shared_->changed.wait_for(lock, kLastAnswer, [this] { return shared_->ended; });
  lock.unlock();
  if (ended)
    thread_.join();
  else
    thread_.detach();
}

void MasterWatch::ask(const std::shared_ptr<Shared>& shared) {
  nameThread("master_watch");
  MasterLine line;
  line.open();
  Clock::time_point asked{};
  std::unique_lock<std::mutex> lock(shared->mutex);
  while (!shared->stop && !shared->lost) {
    lock.unlock();
    const bool broken = line.broken(kPoll);
    bool known = false, lost = false;
    if (broken || Clock::now() - asked >= kPeriod) {
      asked = Clock::now();
      known = (!broken || line.open()) && masterKnowsThisNode();
      lost = broken && !known;
    }
    lock.lock();
    if (known) shared->known = Clock::now();
    shared->lost = lost;
  }
  if (shared->lost && !shared->changed.wait_for(lock, kUnnoticed, [&shared] { return shared->stop; })) MasterLost();
  shared->ended = true;
  shared->changed.notify_all();
}

bool MasterWatch::check() const {
  const std::lock_guard<std::mutex> lock(shared_->mutex);
  // A process that was stopped could not query.
  return !shared_->lost && Clock::now() - std::max(shared_->known, EndWatch::continued()) < kPatience;
}

}  // namespace viscera::nodes
